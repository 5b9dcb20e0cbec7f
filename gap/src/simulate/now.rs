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
    pub(super) bulge: Lanes<L>,
    /// What the row has more of the rate for a line to it to have a curve's mean.
    pub(super) bend: Lanes<L>,
    pub(super) time_s: f64,
}

impl<const L: usize> Now<L> {
    /// On the way to the next instant, the rate along the parabola that the line between both has the mean of.
    #[inline(always)]
    pub(super) fn along(&self, next: &Self, share: f64) -> Self {
        let mut now = self.toward(next, share);
        now.rate += (6.0 * share * (1.0 - share) - 1.0) * now.bend;
        now
    }

    /// The same, as an end of one of so many parts, whose lines have the parabola's means, too.
    #[inline(always)]
    pub(super) fn end(&self, next: &Self, part: u32, parts: u32) -> Self {
        let parts = f64::from(parts);
        let mut now = self.along(next, f64::from(part) / parts);
        now.bend = (1.0 / (parts * parts)) * now.bend;
        now.rate += now.bend;
        now
    }

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
            bend: lines(self.bend, next.bend),
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
            bulge: Lanes::all(self.bulge[lane]),
            bend: Lanes::all(self.bend[lane]),
            time_s: self.time_s,
        }
    }
}
