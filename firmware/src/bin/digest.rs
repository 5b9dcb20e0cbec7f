//! Runs every case in both number systems and prints one line each; the lines of the host and of every board are equal.

#![cfg_attr(target_os = "none", no_std, no_main)]

use gimbal_firmware::cases::CASES;
#[cfg(target_os = "none")]
use gimbal_firmware::semihosting::println;
use gimbal_servo::Fixed;

#[cfg(target_os = "none")]
gimbal_firmware::program!(run);

/// The one program that does its work on the host as well: the host's digests are what the boards' are held to.
#[cfg(not(target_os = "none"))]
fn main() -> Result<(), &'static str> {
    run()
}

fn run() -> Result<(), &'static str> {
    for case in CASES {
        for (number, digest) in [("f32", case.digest::<f32>()), ("fixed", case.digest::<Fixed>())] {
            if digest == 0 {
                return Err("a case's law cannot be built");
            }
            println!("digest {} {number} {} steps {digest:016x}", case.name, case.steps);
        }
    }
    Ok(())
}
