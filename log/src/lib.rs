//! Logs of a gimballed platform: CSV with a header, SI units, one row a sample.
//!
//! The contract is written down in `docs/log.md`. [`Reader`] goes through a file row by row in constant memory,
//! [`Log`] holds its columns, [`import`] turns foreign files into logs, [`TableWriter`] writes them.
//!
//! ```
//! use gimbal_log::{Column, Needs, Reader};
//!
//! let text = "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps\n0,0,1.5,9.8,\n";
//! let mut reader = Reader::new(text.as_bytes(), "flight.csv", Needs::Run)?;
//! let row = reader.next_row()?.expect("one row");
//! assert_eq!(row[Column::AccelY], 1.5);
//! assert!(row[Column::VehicleRate].is_nan(), "an empty cell is a missing sample");
//! # Ok::<(), gimbal_log::LogError>(())
//! ```

#![forbid(unsafe_code)]

mod atomic;
mod batch;
mod cell;
mod column;
mod error;
mod header;
pub mod import;
mod layout;
mod reader;
mod records;
mod row;
mod table;
mod time;
mod write;

pub use atomic::AtomicFile;
pub use batch::Batch;
pub use column::{Column, Needs};
pub use error::{LogError, Problem};
pub use layout::{Layout, Scale};
pub use reader::Reader;
pub use row::Row;
pub use table::{Extra, Log};
pub use time::{Rate, TimeReport};
pub use write::TableWriter;
