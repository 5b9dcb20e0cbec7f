//! Reference of the physics in f64: the paper's equations (1) to (7), integrated continuously.
//!
//! A [`Plant`] is built from the same [`Config`](gimbal_servo::Config) as the real-time model and shares nothing
//! else with it: the servo is a cascade of first-order sections, time is continuous, the step size follows the
//! error, and stops, slip and breaks are located in time.
//!
//! ```
//! use gimbal_plant::{Plant, Row};
//! use gimbal_servo::Config;
//!
//! let plant = Plant::new(&Config::consistent().without_friction())?;
//! // 1e5 dyne cm for a tenth of a second
//! let step = Row { torque_nm: 0.01, ..Row::default() };
//! let last = plant.run(std::iter::repeat_n(step, 101)).last().unwrap();
//! assert!(last.gimbal_angle_rad > 0.0);
//! # Ok::<(), gimbal_servo::BuildError>(())
//! ```

#![forbid(unsafe_code)]

mod advance;
mod bearing;
mod crossing;
mod effects;
mod friction;
mod guard;
mod plant;
mod platform;
mod row;
mod runge_kutta;
mod sample;
mod servo;
mod state;
mod system;
mod tableau;
mod vector;

pub use effects::{Block, Bound, Effect, EffectError, Parameter};
pub use plant::Plant;
pub use platform::{Platform, PlatformSample};
pub use row::{Between, Row};
pub use sample::{Logged, Sample};
pub use state::{Quantity, State, Stop, StopEvent, StopEventKind};
