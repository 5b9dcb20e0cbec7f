//! Somebody else's program: it depends on the library by path and flies one of the digest's cases.
//!
//! 0.035 N m for 0.4 s, nothing for 0.3 s, the same the other way, under 1 g along the gimbal axis.

use gimbal_servo::{BuildError, Config, Digest, Fixed, Input, Number};

const STEPS: u32 = 10_000;

fn main() -> Result<(), BuildError> {
    println!("digest stops f32 {STEPS} steps {:016x}", digest::<f32>()?);
    println!("digest stops fixed {STEPS} steps {:016x}", digest::<Fixed>()?);
    Ok(())
}

fn digest<N: Number>() -> Result<u64, BuildError> {
    let law = Config::consistent().build::<N>()?;
    let mut state = law.start();
    let mut digest = Digest::default();
    for k in 0..STEPS {
        let torque_nm = match k % 1400 {
            0..400 => 0.035,
            700..1100 => -0.035,
            _ => 0.0,
        };
        let row = Input { torque_nm, accel_z_mps2: 9.80665, ..Input::default() };
        digest.add_output(&law.step(&mut state, law.units().input(&row)));
    }
    for sum in law.velocity_error_mps(&state).into_iter().chain(law.position_error_m(&state)) {
        digest.add(&sum.to_bits().to_le_bytes());
    }
    Ok(digest.value())
}
