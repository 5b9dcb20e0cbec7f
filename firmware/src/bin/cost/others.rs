//! Other crates on the part of the same work that they can do: the linear loop, nine states, one input, three outputs.
//!
//! As second-order sections that is five for each output; as a dense system a 9 x 9 matrix, and 3 x 9 for the outputs.
//! Their counts do not depend on the coefficients. None of them has friction, stops or INS sums, and none reaches the
//! accuracy of the modes (`docs/number-systems.md`); the counts are of the arithmetic alone.

use crate::tally::Tally;
use biquad::Biquad as _;
use core::hint::black_box;
use dsp_process::SplitProcess as _;
use gimbal_firmware::counter::Counter;
use gimbal_firmware::semihosting::println;
use micromath::F32Ext;

const STEPS: u32 = 100;
/// Sections of one output: four of second order and one of first.
const SECTIONS: usize = 5;
const OUTPUTS: usize = 3;

/// A slow mode, well damped: any stable section does.
const B: [f32; 3] = [0.1, 0.05, 0.02];
const A: [f32; 2] = [-1.2, 0.4];

pub(crate) fn count(counter: &mut Counter) {
    sections_of_biquad(counter);
    sections_of_idsp(counter);
    sections_of_idsp_fixed(counter);
    dense_nalgebra(counter);
    root_of_micromath(counter);
}

fn sections_of_biquad(counter: &mut Counter) {
    let [b0, b1, b2] = B;
    let [a1, a2] = A;
    let section = biquad::DirectForm2Transposed::<f32>::new(biquad::Coefficients { a1, a2, b0, b1, b2 });
    let mut sections = black_box([[section; SECTIONS]; OUTPUTS]);
    over(counter, "biquad-sections", "f32", |x| {
        let mut outputs = [0.0; OUTPUTS];
        for (output, cascade) in outputs.iter_mut().zip(&mut sections) {
            *output = cascade.iter_mut().fold(x, |signal, section| section.run(signal));
        }
        outputs
    });
}

fn sections_of_idsp(counter: &mut Counter) {
    let section = idsp::iir::Biquad { ba: [B[0], B[1], B[2], -A[0], -A[1]] };
    let law: [[_; SECTIONS]; OUTPUTS] = black_box(core::array::from_fn(|_| core::array::from_fn(|_| section.clone())));
    let mut states: [[idsp::iir::DirectForm2Transposed<f32>; SECTIONS]; OUTPUTS] = Default::default();
    over(counter, "idsp-sections", "f32", |x| {
        let mut outputs = [0.0; OUTPUTS];
        for ((output, cascade), states) in outputs.iter_mut().zip(&law).zip(&mut states) {
            *output = cascade.iter().zip(states).fold(x, |signal, (section, state)| section.process(state, signal));
        }
        outputs
    });
}

/// Its wide form: 64-bit outputs fed back, which a slow mode needs.
fn sections_of_idsp_fixed(counter: &mut Counter) {
    use dsp_fixedpoint::Q;
    let coef = |value: f32| Q::<i32, i64, 29>::from_f32(value);
    let section = idsp::iir::Biquad { ba: [coef(B[0]), coef(B[1]), coef(B[2]), coef(-A[0]), coef(-A[1])] };
    let law: [[_; SECTIONS]; OUTPUTS] = black_box(core::array::from_fn(|_| core::array::from_fn(|_| section.clone())));
    let mut states: [[idsp::iir::DirectForm1Wide; SECTIONS]; OUTPUTS] = Default::default();
    over(counter, "idsp-sections", "fixed", |x| {
        #[allow(clippy::cast_possible_truncation, reason = "below 2^30")]
        let x = (x * 1e6) as i32;
        let mut outputs = [0; OUTPUTS];
        for ((output, cascade), states) in outputs.iter_mut().zip(&law).zip(&mut states) {
            *output = cascade.iter().zip(states).fold(x, |signal, (section, state)| section.process(state, signal));
        }
        outputs
    });
}

fn dense_nalgebra(counter: &mut Counter) {
    let a = black_box(nalgebra::SMatrix::<f32, 9, 9>::from_fn(|i, j| if i == j { 0.9 } else { 0.01 }));
    let b = black_box(nalgebra::SVector::<f32, 9>::repeat(0.1));
    let c = black_box(nalgebra::SMatrix::<f32, 3, 9>::repeat(0.2));
    let mut x = nalgebra::SVector::<f32, 9>::zeros();
    over(counter, "nalgebra-dense", "f32", |u| {
        x = a * x + b * u;
        c * x
    });
}

/// micromath's square root of the sum of two squares: few instructions, and an error that the friction level does not bear.
fn root_of_micromath(counter: &mut Counter) {
    let mut worst = 0.0_f32;
    over(counter, "micromath-root", "f32", |x| F32Ext::sqrt(x * x + 3.0));
    for k in 0..1_000_u16 {
        let square = 1.0 + 3.0 * f32::from(k) / 1_000.0;
        let root = F32Ext::sqrt(square);
        worst = worst.max(F32Ext::abs(root * root / square - 1.0) / 2.0);
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "parts in a million, below 10^6")]
    let ppm = (worst * 1e6) as u32;
    println!("error micromath-root f32 {ppm}");
}

fn over<T>(counter: &mut Counter, name: &str, number: &str, mut work: impl FnMut(f32) -> T) {
    let mut tally = Tally::EMPTY;
    for k in 0..STEPS {
        let x = black_box(if k % 20 < 10 { 0.5 } else { -0.5 });
        tally.add(counter.count(|| {
            black_box(work(x));
        }));
    }
    tally.print("cost", name, number);
}
