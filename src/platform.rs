//! Three gimbal axes: a platform's attitude error as a vector, and its velocity error.
//!
//! ```text
//! dV' = a x phi                                                                                         (7), as vectors
//! ```
//!
//! Outer, middle and inner gimbal turn about one of the axes x, y, z each, in any order; the inner one is the stable
//! member. Each axis is one loop of the model and one estimator; the gimbal angles turn forces, rates and angles from one
//! gimbal's axes into the next one's. The derivation and its limits stand in `docs/platform.md`.
//!
//! ```
//! use gimbal_servo::platform::{Axis, Config, Input};
//!
//! let law = Config::new([Axis::X, Axis::Y, Axis::Z]).build::<f32>()?;
//! let mut state = law.start();
//! // once a millisecond:
//! let input = Input { accel_mps2: [0.0, 98.0, 9.8], gimbal_angle_rad: [0.1, 0.0, -0.4], ..Input::default() };
//! let output = law.step(&mut state, &law.input(&input));
//! assert!(!output.gimbal_lock);
//! # Ok::<(), gimbal_servo::BuildError>(())
//! ```

mod config;
mod law;
mod resolver;
mod signals;
mod state;
mod turn;

pub use config::{Axis, Config, Gimbal};
pub use law::Law;
pub use signals::{Estimate, Input, Output};
pub use state::State;
