//! Model files: the parameters of one gimbal axis as TOML, in SI units, on top of a preset.
//!
//! The form is written down in `docs/model-file.md`. Names are those of the fields of [`gimbal_servo::Config`].
//!
//! ```
//! use gimbal_model_file::ModelFile;
//!
//! let text = "preset = \"consistent\"\n[servo]\ngain_nm_per_rad_s = 8.5\n";
//! let model = ModelFile::parse(text, "bench.toml")?;
//! assert_eq!(model.config.servo.gain_nm_per_rad_s, 8.5);
//! let wrong = ModelFile::parse("[servo]\ngain_nm_per_rad = 8.5\n", "bench.toml").unwrap_err();
//! assert_eq!(
//!     wrong.to_string(),
//!     "bench.toml: line 2, column 1: `gain_nm_per_rad` is not a key of [servo]; the nearest known one is \
//!      `gain_nm_per_rad_s`"
//! );
//! # Ok::<(), gimbal_model_file::ModelFileError>(())
//! ```

#![forbid(unsafe_code)]

pub mod axis;
pub mod effects;
mod error;
mod fields;
pub mod known_good;
mod merge;
mod place;
mod read;
mod tolerance;
mod write;

pub use axis::AxisModel;
pub use effects::ModelEffect;
pub use error::{ModelFileError, Problem};
pub use read::{ModelFile, Preset};
pub use tolerance::Tolerance;
pub use write::{write, write_model};
