//! What a stop leaves behind: nobody knows the state that the float is let go with.
//!
//! The way onto a stop, the time there and the way off it take every parameter for what it is several times over; what
//! is left of that, the loop remembers for seconds. So the state after a stop is any: each place of it adds
//! `a e / s` to the whitened channels until the next stop, and is whitened as the turns of the bearing are
//! ([`super::slip`]), after them. What the rows after a stop say is what they say of a platform that begins there.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::draft::Draft;
use super::normal::{drive, gram, slices, solve};
use super::signals::{Kept, Signals, scaled, valid};
use super::slip::over_nothing;

/// How much further than at the beginning the state may be from where the prediction has it.
const FURTHER: f64 = 10.0;

/// What each place of the state after the stops shows, over the noise, before any filter.
#[derive(Debug, Clone, Default)]
pub(crate) struct Released {
    /// Rows after each stop, to the next.
    free: Vec<Range<usize>>,
    /// Places of the state.
    places: Arc<[Kept]>,
}

impl Released {
    /// Of a platform.
    pub(crate) fn new(draft: &Draft) -> Self {
        let free = draft.record.anew().to_vec();
        if free.is_empty() {
            return Self::default();
        }
        let rows: Vec<usize> = free.iter().map(|free| free.start).collect();
        let counts = valid(draft.record);
        let counted = |place: Kept| {
            let mut signals = place.signals();
            for signal in &mut signals {
                signal.iter_mut().zip(&counts).filter(|(_, counts)| !**counts).for_each(|(value, _)| *value = 0.0);
            }
            Kept::new(&signals)
        };
        Self { places: draft.pushed(&rows).into_iter().map(counted).collect(), free }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.free.is_empty()
    }

    /// A residual over the noise without what the state after each stop makes of it, by least squares.
    pub(crate) fn without(&self, residual: &Signals) -> Signals {
        let mut rest = residual.clone();
        for free in &self.free {
            let of = |place: &Kept| -> Vec<f32> {
                place.channels().iter().flat_map(|signal| signal[free.clone()].iter().copied()).collect()
            };
            let columns: Vec<Vec<f32>> = self.places.iter().map(of).collect();
            let right: Vec<f64> = residual.iter().flat_map(|signal| signal[free.clone()].iter().copied()).collect();
            let chosen: Vec<usize> = (0..columns.len()).collect();
            let weights = vec![1.0 / (FURTHER * FURTHER); columns.len()];
            let columns = slices(&columns);
            let Some(solution) = solve(&gram(&columns, 0..right.len()), &drive(&columns, &right), &chosen, &weights)
            else {
                continue;
            };
            for (place, coefficient) in self.places.iter().zip(solution.coefficients.iter()) {
                for (rest, shown) in rest.iter_mut().zip(place.channels()) {
                    for (rest, shown) in rest[free.clone()].iter_mut().zip(&shown[free.clone()]) {
                        *rest -= coefficient * f64::from(*shown);
                    }
                }
            }
        }
        rest
    }

    /// Each stop's and place's samples after the filter, and where they begin.
    pub(crate) fn shown(&self, filter: impl Fn(&Signals) -> Vec<f64> + Sync) -> Vec<(usize, Vec<f64>)> {
        let pairs: Vec<(&Range<usize>, &Kept)> =
            self.free.iter().flat_map(|free| self.places.iter().map(move |place| (free, place))).collect();
        let shown = |(free, place): &(&Range<usize>, &Kept)| {
            let mut signals = place.signals();
            for signal in &mut signals {
                signal[..free.start].fill(0.0);
                signal[free.end..].fill(0.0);
            }
            let by = vec![FURTHER; signals.len()];
            over_nothing(&filter(&scaled(signals, &by)))
        };
        pairs.par_iter().map(shown).collect()
    }
}
