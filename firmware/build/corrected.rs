//! Images of the laws with effects, for boards that have no memory to build one.

#[allow(unreachable_pub, reason = "a module of the library")]
#[path = "../src/effects.rs"]
mod sizes;

use gimbal_servo::effects::{Config as Effects, Law};
use gimbal_servo::{Config, Fixed, Number};
use std::error::Error;
use std::fs;
use std::path::Path;

/// Writes `all-f32.image` and its like.
pub(crate) fn write(out: &Path) -> Result<(), Box<dyn Error>> {
    for (name, effects) in [("all", sizes::all()), ("three", sizes::three())] {
        fs::write(out.join(format!("{name}-f32.image")), image::<f32>(&effects)?)?;
        fs::write(out.join(format!("{name}-fixed.image")), image::<Fixed>(&effects)?)?;
    }
    Ok(())
}

fn image<N: Number>(effects: &Effects) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut image = vec![0; Law::<N>::IMAGE_LEN];
    Config::consistent().build_with::<N>(effects)?.to_image(&mut image)?;
    Ok(image)
}
