//! Runs every case in both number systems and prints one line each; the lines of the host and of every board are equal.

#![cfg_attr(target_os = "none", no_std, no_main)]

use gimbal_firmware::cases::{CASES, Case, FLIGHT, STOPS};
#[cfg(target_os = "none")]
use gimbal_firmware::semihosting::println;
use gimbal_firmware::{board, corrected, estimates};
use gimbal_servo::Fixed;

#[cfg(target_os = "none")]
gimbal_firmware::program!(run);

/// The one program that does its work on the host as well: the host's digests are what the boards' are held to.
#[cfg(not(target_os = "none"))]
fn main() -> Result<(), &'static str> {
    run()
}

/// What it takes to build a law with effects, an estimator beside an axis, and three of both. With less, effects come from
/// an image.
const EFFECTS_RAM_BYTES: u32 = 32 * 1024;
const ESTIMATOR_RAM_BYTES: u32 = 32 * 1024;
const PLATFORM_RAM_BYTES: u32 = 128 * 1024;

fn run() -> Result<(), &'static str> {
    for case in CASES {
        told(case.name, case.steps, [case.digest::<f32>(), case.digest::<Fixed>()])?;
    }
    for corrected in corrected::CASES {
        let (Case { name, steps, .. }, [float, fixed]) = (corrected.case, corrected.images);
        let digests = if has(EFFECTS_RAM_BYTES) {
            [corrected.digest::<f32>(), corrected.digest::<Fixed>()]
        } else {
            [corrected.image_digest::<f32>(float), corrected.image_digest::<Fixed>(fixed)]
        };
        told(name, steps, digests)?;
    }
    if has(ESTIMATOR_RAM_BYTES) {
        let flight = Case { name: "estimator-flight", steps: 3_000, ..FLIGHT };
        let stops = Case { name: "estimator-stops", steps: 3_000, ..STOPS };
        for case in [flight, stops] {
            told(case.name, case.steps, [estimates::digest::<f32>(&case), estimates::digest::<Fixed>(&case)])?;
        }
    }
    if has(PLATFORM_RAM_BYTES) {
        let digests = [estimates::platform_digest::<f32>(), estimates::platform_digest::<Fixed>()];
        told("platform", estimates::PLATFORM_STEPS, digests)?;
    }
    Ok(())
}

/// Whether there is so much memory; the constants of a host say so.
fn has(bytes: u32) -> bool {
    board::RAM_BYTES / bytes > 0
}

fn told(name: &str, steps: u32, [float, fixed]: [u64; 2]) -> Result<(), &'static str> {
    for (number, digest) in [("f32", float), ("fixed", fixed)] {
        if digest == 0 {
            return Err("a case's law cannot be built");
        }
        println!("digest {name} {number} {steps} steps {digest:016x}");
    }
    Ok(())
}
