//! Foreign files into logs: columns by a map, units into SI, one constant rate.

mod altos;
mod frame;
mod map;
mod resample;
mod unit;

pub use altos::{GimbalAxis, is_altos, roll_rate_radps};
pub use frame::{take_out_roll, turn_into_stable_member};
pub use map::{ColumnMap, Source, header_names, read};
pub use resample::{Resampled, Span, resample};
pub use unit::{NAMES as UNIT_NAMES, scale};
