//! Load torques along a track, found once for all platforms that run along it.

use crate::palmgren::Palmgren;
use crate::track::Track;

/// Load torque of the bearings along a track, at the begin, the middle and the end of every step [N m]: the same for
/// every platform that runs along it.
#[derive(Debug, Clone)]
pub struct Loads {
    pub(super) steps_per_row: usize,
    /// Two a step: begin and middle; the end is the next begin.
    halves_nm: Vec<f64>,
}

impl Loads {
    /// For platforms with these bearings.
    #[must_use]
    pub fn new(bearing: &gimbal_servo::bearing::Config, track: &Track, steps_per_row: usize) -> Self {
        let palmgren = Palmgren::new(bearing);
        let halves = 2 * steps_per_row;
        let halves_nm = (0..=(track.rows.len() - 1) * halves)
            .map(|half| {
                let (from, to) = track.around(half / halves);
                palmgren.load_nm(from.towards(to, (half % halves) as f64 / halves as f64).accel_mps2)
            })
            .collect();
        Self { steps_per_row, halves_nm }
    }

    pub(super) fn of_step(&self, row: usize, step: usize) -> Option<[f64; 3]> {
        let first = 2 * (row * self.steps_per_row + step);
        self.halves_nm.get(first..first + 3).map(|three| [three[0], three[1], three[2]])
    }
}
