//! Attitude error from the gyro, with an honest bound, through saturation and sensor faults.
//!
//! ```text
//! Jo theta'' = H phi' - Bo theta'     =>     phi = (Bo theta + Jo theta') / H + offset                   (2), integrated
//! Jg phi''   = T_d - H theta' - T_m                                                                      (1)
//! ```
//!
//! While the gyro's float is free, a Kalman filter of steady gain reads theta, theta', phi' and `T_d` from the measured
//! theta and motor torque. While it sits on a stop, phi is carried by (1) alone; at the release phi' is zero, and what
//! the balance says instead corrects it. The derivation stands in `docs/estimator.md`.
//!
//! ```
//! use gimbal_servo::{Config, Input, estimator};
//!
//! let config = Config::consistent();
//! let (axis, estimator) = (config.build::<f32>()?, estimator::Config::default().build::<f32>(&config)?);
//! let (mut model, mut state) = (axis.start(), estimator.start());
//! // once a millisecond:
//! let modelled = axis.step(&mut model, Input { accel_y_mps2: 9.8, ..Input::default() });
//! let measured = estimator::Measured { gyro_angle_rad: Some(1e-5), motor_torque_nm: Some(2e-4) };
//! let estimate = estimator.step(&mut state, &measured, &axis, &model, modelled.faults);
//! assert!(estimate.bound_rad > 0.0);
//! # Ok::<(), gimbal_servo::BuildError>(())
//! ```

mod bound;
mod closely;
mod config;
mod contact;
mod filter;
mod flags;
mod health;
mod held;
mod law;
mod matrix;
mod on_stop;
mod release;
mod servo;
mod signals;
mod state;
mod step;
pub(crate) mod sums;

pub use config::{Config, Sensors, Tolerance};
pub use flags::Flags;
pub use law::Law;
pub use signals::{Estimate, Measured};
pub use state::State;
