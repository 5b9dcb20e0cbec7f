//! The step alone, and estimator and gap monitor alone, as functions of their own: what the gates examine and the budget
//! measures. With the feature `effects` the step is that of the law with effects, by itself as a program flies it.
//!
//! Linked with `panic-never`, whose panic handler exists in no library: where a panic can be reached the link fails.
//! There is no global allocator, so code that allocates does not build either.
//! Nothing here builds a law, for that may fail and uses doubles.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod target {
    // Symbols that the image keeps by name: unmangled names are unsafe because two could be equal.
    #![allow(unsafe_code)]

    #[cfg(feature = "effects")]
    use gimbal_servo::effects::{Law as Flown, State as FlownState};
    use gimbal_servo::estimator::{self, Estimate, Flags, Measured};
    use gimbal_servo::{Faults, Fixed, Input, Law, Number, Output, State, monitor};
    #[cfg(not(feature = "effects"))]
    use gimbal_servo::{Law as Flown, State as FlownState};
    #[cfg(not(feature = "panic-allowed"))]
    use panic_never as _;

    #[cfg(feature = "panic-allowed")]
    gimbal_firmware::stop_at_panic!();
    gimbal_firmware::idle_program!();

    /// Named in the image and in `xtask/src/board/gates.rs`.
    #[unsafe(no_mangle)]
    extern "C" fn step_f32(
        law: &Flown<f32>,
        state: &mut FlownState<f32>,
        input: &Input<f32>,
        output: &mut Output<f32>,
    ) {
        step(law, state, input, output);
    }

    /// Named in the image and in `xtask/src/board/gates.rs`.
    #[unsafe(no_mangle)]
    extern "C" fn step_fixed(
        law: &Flown<Fixed>,
        state: &mut FlownState<Fixed>,
        input: &Input<Fixed>,
        output: &mut Output<Fixed>,
    ) {
        step(law, state, input, output);
    }

    #[inline(always)]
    fn step<N: Number>(law: &Flown<N>, state: &mut FlownState<N>, input: &Input<N>, output: &mut Output<N>) {
        *output = law.step(state, *input);
        spoil();
    }

    /// What estimator and monitor take, and what they give.
    pub(crate) struct Aids<'a, N: Number> {
        laws: (&'a Law<N>, &'a estimator::Law<N>, &'a monitor::Law<N>),
        model: &'a State<N>,
        faults: Faults,
        measured: Measured<N>,
        states: (estimator::State<N>, monitor::State<N>),
        told: (Estimate<N>, monitor::Report<N>),
    }

    /// Named in the image and in `xtask/src/board/gates.rs`.
    #[unsafe(no_mangle)]
    extern "C" fn aids_f32(aids: &mut Aids<f32>) {
        help(aids);
    }

    /// Named in the image and in `xtask/src/board/gates.rs`.
    #[unsafe(no_mangle)]
    extern "C" fn aids_fixed(aids: &mut Aids<Fixed>) {
        help(aids);
    }

    #[inline(always)]
    fn help<N: Number>(aids: &mut Aids<N>) {
        let Aids { laws: (axis, estimator, monitor), model, faults, measured, states: (state, watch), told } = aids;
        let estimate = estimator.step(state, measured, axis, model, *faults);
        if estimate.flags.contains(Flags::SATURATED) {
            monitor.pause(watch);
        }
        *told = (estimate, monitor.step(watch, measured.gyro_angle_rad, model));
        spoil();
    }

    /// Does one thing that is forbidden, if a feature asks for it.
    #[inline(always)]
    fn spoil() {
        #[cfg(feature = "bad-panic")]
        bad::panic();
        #[cfg(feature = "bad-double")]
        bad::double();
        #[cfg(feature = "bad-alloc")]
        bad::alloc();
        #[cfg(feature = "bad-recursion")]
        bad::recursion(core::hint::black_box(3));
        #[cfg(feature = "bad-indirect")]
        bad::indirect();
    }

    type Step<N> = extern "C" fn(&Flown<N>, &mut FlownState<N>, &Input<N>, &mut Output<N>);

    type Help<N> = extern "C" fn(&mut Aids<'_, N>);

    /// Keeps them in the image.
    #[used]
    static STEPS: (Step<f32>, Step<Fixed>, Help<f32>, Help<Fixed>) = (step_f32, step_fixed, aids_f32, aids_fixed);

    /// One thing each that the step must not do.
    #[cfg(any(
        feature = "bad-panic",
        feature = "bad-double",
        feature = "bad-alloc",
        feature = "bad-recursion",
        feature = "bad-indirect"
    ))]
    #[allow(dead_code, reason = "one of them at a time is called")]
    mod bad {
        use core::hint::black_box;

        pub(super) fn panic() {
            let table = [1, 2, 3];
            black_box(table[black_box(2_usize)]);
        }

        pub(super) fn double() {
            black_box(black_box(2.0_f64) * black_box(3.0_f64));
        }

        #[inline(never)]
        pub(super) fn recursion(depth: u32) -> u32 {
            if depth == 0 { 0 } else { black_box(recursion(depth - 1)) + 1 }
        }

        pub(super) fn indirect() {
            let function: fn() = black_box(double);
            function();
        }

        #[cfg(feature = "bad-alloc")]
        pub(super) fn alloc() {
            extern crate alloc;
            use core::alloc::Layout;

            // SAFETY: the layout is not empty; what is returned is only looked at.
            black_box(unsafe { alloc::alloc::alloc(Layout::new::<u64>()) });
        }
    }
}
