//! The inputs at one instant.

use super::lanes::Lanes;

/// As each prediction has them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Now<const L: usize> {
    pub(super) accel: [Lanes<L>; 3],
    pub(super) rate: Lanes<L>,
    pub(super) load: Lanes<L>,
    pub(super) cross: f64,
    pub(super) turned: f64,
    pub(super) bulge: f64,
    pub(super) time_s: f64,
}

impl<const L: usize> Now<L> {
    /// On the line to the next instant.
    #[inline(always)]
    pub(super) fn toward(&self, next: &Self, share: f64) -> Self {
        let line = |a: f64, b: f64| a + share * (b - a);
        let lines = |a: Lanes<L>, b: Lanes<L>| a + share * (b - a);
        let [x, y, z] = self.accel;
        let [next_x, next_y, next_z] = next.accel;
        Self {
            accel: [lines(x, next_x), lines(y, next_y), lines(z, next_z)],
            rate: lines(self.rate, next.rate),
            load: lines(self.load, next.load),
            cross: line(self.cross, next.cross),
            turned: line(self.turned, next.turned),
            bulge: next.bulge,
            time_s: line(self.time_s, next.time_s),
        }
    }

    /// Of one prediction.
    pub(super) fn of(&self, lane: usize) -> Now<1> {
        Now {
            accel: self.accel.map(|axis| Lanes::all(axis[lane])),
            rate: Lanes::all(self.rate[lane]),
            load: Lanes::all(self.load[lane]),
            cross: self.cross,
            turned: self.turned,
            bulge: self.bulge,
            time_s: self.time_s,
        }
    }
}
