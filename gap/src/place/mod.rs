//! Where the gap lies: in frequency, time, regime and block.

mod bands;
mod blocks;
mod regimes;
mod spans;

pub use bands::{Band, Spectrum};
pub use blocks::shares as block_shares;
pub use regimes::{Regime, regimes};
pub use spans::{Span, spans};
