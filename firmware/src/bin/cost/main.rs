//! Counts the instructions of the step, each single one of ten seconds of flight and of ten seconds between the stops;
//! of its blocks by themselves; of estimator and monitor; of the frames of a bench; and of other crates that do part of
//! the same work. With the feature `effects`: of the step with effects alone.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod aids;
#[cfg(target_os = "none")]
mod corrected;
#[cfg(target_os = "none")]
mod model;
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod others;
#[cfg(target_os = "none")]
mod parts;
#[cfg(target_os = "none")]
mod tally;
#[cfg(target_os = "none")]
mod wire;

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
gimbal_firmware::program!(run);

#[cfg(target_os = "none")]
fn run() -> Result<(), &'static str> {
    use gimbal_firmware::{board, counter::Counter, semihosting::println};
    use gimbal_servo::{Fixed, State, estimator};

    /// What it takes to build an estimator beside an axis: matrices in double precision, and three laws.
    const AIDS_RAM_BYTES: u32 = 32 * 1024;

    let mut counter = Counter::start();
    if cfg!(feature = "effects") {
        return corrected::run(&mut counter);
    }
    println!("size f32 {} {}", size_of::<State<f32>>(), size_of::<gimbal_servo::Law<f32>>());
    println!("size fixed {} {}", size_of::<State<Fixed>>(), size_of::<gimbal_servo::Law<Fixed>>());
    println!("size-estimator f32 {} {}", size_of::<estimator::State<f32>>(), size_of::<estimator::Law<f32>>());
    println!("size-estimator fixed {} {}", size_of::<estimator::State<Fixed>>(), size_of::<estimator::Law<Fixed>>());
    let counter = &mut counter;
    for case in model::cases() {
        model::count::<f32>(counter, case, "f32")?;
        model::count::<Fixed>(counter, case, "fixed")?;
    }
    if cfg!(feature = "brief") {
        return Ok(());
    }
    parts::count::<f32>(counter, "f32")?;
    parts::count::<Fixed>(counter, "fixed")?;
    wire::count(counter, "f32")?;
    wire::count(counter, "fixed")?;
    if board::RAM_BYTES >= AIDS_RAM_BYTES {
        for case in aids::CASES {
            aids::count::<f32>(counter, &case, "f32")?;
            aids::count::<Fixed>(counter, &case, "fixed")?;
        }
    }
    #[cfg(target_arch = "arm")]
    others::count(counter);
    Ok(())
}
