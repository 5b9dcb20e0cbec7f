//! What is said of a change away from where the bearing turns around. There the noise of the logged rate shifts the turn, and
//! so does a torque that lasts, or inputs that are late: how large that noise is, is known least.

use super::set::with_one_less;
use crate::fit::{Fit, Search};

/// Effects that shift the turn.
const SHIFTING: [&str; 3] = ["float_torque", "g_sensitive_float_torque", "time_skew"];
/// Share of a change's power away from turns below which it is seen at turns alone.
const AWAY: f64 = 0.15;

/// What changes one residual into another.
pub(super) struct Change {
    /// Away from turns, its product with the first, and its square.
    along: f64,
    square: f64,
    /// Its square in all rows.
    all: f64,
}

impl Change {
    pub(super) fn new(before: &[f64], after: &[f64], away: &[bool]) -> Self {
        let width = before.len() / away.len().max(1);
        let mut own = Self { along: 0.0, square: 0.0, all: 0.0 };
        for (row, counts) in away.iter().enumerate() {
            for k in row * width..(row + 1) * width {
                let change = before[k] - after[k];
                own.all += change * change;
                if *counts {
                    own.along += change * before[k];
                    own.square += change * change;
                }
            }
        }
        own
    }

    /// What is said for it away from turns [nats]: `(d . r)^2 / (2 d . d)`.
    pub(super) fn told(&self) -> f64 {
        if self.along > 0.0 { 0.5 * self.along * self.along / self.square } else { 0.0 }
    }

    /// Whether next to nothing of it is away from turns.
    pub(super) fn is_at_turns(&self) -> bool {
        self.square < AWAY * self.all
    }
}

/// How many effects of a fit shift turns, and are seen there alone: against what the nominal parameters leave, or what the
/// closest set leaves that has all of them but one.
pub(super) fn at_turns_alone(search: &Search, fit: &Fit, away: &[bool]) -> usize {
    let is_seen_there = |effect: &&'static str| {
        let smaller = with_one_less(search, fit, effect).min_by(|a, b| a.square.total_cmp(&b.square));
        smaller.is_some_and(|smaller| Change::new(&smaller.residual, &fit.residual, away).is_at_turns())
    };
    fit.effects.iter().copied().filter(|effect| SHIFTING.contains(effect)).filter(is_seen_there).count()
}

#[cfg(test)]
mod tests {
    use super::Change;

    #[test]
    fn closed_form_what_rows_say_for_a_change_that_is_theirs() {
        // two channels; the change is all of what the second row has, and what the first one has not
        let (before, after) = ([1.0, 0.0, 3.0, 4.0], [1.0, 1.0, 0.0, 0.0]);
        let of = |rows: [bool; 2]| Change::new(&before, &after, &rows);
        assert!((of([false, true]).told() - 0.5 * 25.0).abs() < 1e-12);
        assert!(of([true, false]).told() == 0.0);
        assert!(of([true, false]).is_at_turns());
        assert!(!of([false, true]).is_at_turns());
    }
}
