//! What the tests of the library share: runs of the law in both number systems, inputs, and references of their own.
//!
//! The tests are in `tests/`, one file a subject. A test's name says where its truth comes from: `closed_form_`,
//! `paper_`, `cross_` (another program: the f64 plant, or the exact discretisation in [`exact`]) or `regress_`.

pub mod axis;
pub mod compare;
pub mod digests;
pub mod estimate;
pub mod estimate_faults;
pub mod estimate_figures;
pub mod exact;
pub mod figures;
pub mod hour;
pub mod inputs;
pub mod random;
pub mod rocket;

pub use gimbal_plant::Row;
