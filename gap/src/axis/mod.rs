//! A plain servo axis without a gyro: the same questions, asked of effort and motion.
//!
//! The method, its library and its limits: `docs/axis.md`.

mod balance;
mod beat;
mod beside;
mod channels;
mod columns;
mod diagnose;
mod experiment;
mod floor;
mod follows;
mod judge;
mod law;
mod library;
mod looked;
mod memory;
mod motion;
mod noise;
mod place;
mod plain;
mod play;
mod ready;
mod refine;
mod regress;
mod report;
mod resonance;
mod search;
mod slip;
mod smooth;
mod table;
mod tried;
mod units;
mod unseen;
mod waves;
mod zero;

pub use columns::ColumnFault;
pub use diagnose::{AxisDiagnosis, diagnose};
pub use judge::{Found, Parameter, Ranked, Shrunk};
pub use motion::MotionFrom;
pub use place::{AxisRegime, FrictionCurve};
pub use report::{html, json, text};
pub use table::{AxisLog, AxisLogError};
