//! Where a platform begins anew: after a stop, which it leaves in a state that nobody knows, and after rows whose inputs are
//! missing.

use std::ops::Range;

use super::Record;

/// How long before a stop a platform that is a little off may be on it already, and how long after it what follows is not in
/// proportion to what it was let go with [s].
const COMES_S: f64 = 0.02;
const SETTLES_S: f64 = 0.5;
/// Shortest time away from a stop that is worth the ten unknowns of its beginning [s].
const WORTH_S: f64 = 0.3;
/// Most of them, and most gaps that are looked at; shorter ones are left out first.
const MOST_RUNS: usize = 32;

impl Record {
    /// Masks the time on a stop and what follows it for a while.
    pub(super) fn leave_out(&mut self, on_stop: &[bool]) {
        let mut free =
            away(on_stop, [COMES_S, SETTLES_S].map(|time_s| self.inputs.rows_of(time_s)), self.inputs.rows_of(WORTH_S));
        keep_longest(&mut free, MOST_RUNS);
        self.away_from_stop = Some(free.iter().max_by_key(|free| free.len()).cloned().unwrap_or_default());
        self.begins_anew(&free);
        self.notes.push(format!(
            "the float was {} a stop for {:.2} s; masked with {SETTLES_S} s after each, and the platform begins anew there",
            if self.plateau_rad.is_some() { "on" } else { "near" },
            on_stop.iter().filter(|on_stop| **on_stop).count() as f64 * self.inputs.period_s
        ));
    }

    /// After rows whose inputs are not known, and nowhere else.
    pub(super) fn begins_anew_after_gaps(&mut self) {
        let all = 0..self.rows();
        self.begins_anew(std::slice::from_ref(&all));
    }

    /// Takes these rows, too, for ones whose inputs are not known.
    pub(super) fn does_not_know(&mut self, rows: Vec<Range<usize>>) {
        self.unknown = worst(self.unknown.iter().cloned().chain(rows).collect());
        self.begins_anew_after_gaps();
    }

    /// Masks what is not in these runs and rows whose inputs are not known: the platform begins anew after each.
    fn begins_anew(&mut self, free: &[Range<usize>]) {
        let free = without(free, &self.unknown);
        for channel in &mut self.channels {
            let mut valid = vec![false; channel.valid.len()];
            for free in &free {
                valid[free.clone()].copy_from_slice(&channel.valid[free.clone()]);
            }
            channel.valid = valid;
        }
        self.anew = free.into_iter().filter(|free| free.start > 0).collect();
    }
}

/// The longest of some runs, in their order.
fn keep_longest(runs: &mut Vec<Range<usize>>, most: usize) {
    if runs.len() > most {
        runs.sort_by_key(|run| std::cmp::Reverse(run.len()));
        runs.truncate(most);
        runs.sort_by_key(|run| run.start);
    }
}

/// Runs of rows that are in any of some.
pub(super) fn merged(mut some: Vec<Range<usize>>) -> Vec<Range<usize>> {
    some.sort_by_key(|run| run.start);
    let mut runs: Vec<Range<usize>> = Vec::new();
    for run in some {
        match runs.last_mut() {
            Some(last) if run.start <= last.end => last.end = last.end.max(run.end),
            _ => runs.push(run),
        }
    }
    runs
}

/// The longest of them.
pub(super) fn worst(some: Vec<Range<usize>>) -> Vec<Range<usize>> {
    let mut runs = merged(some);
    keep_longest(&mut runs, MOST_RUNS);
    runs
}

/// Runs of rows without those of others.
fn without(runs: &[Range<usize>], others: &[Range<usize>]) -> Vec<Range<usize>> {
    let mut left = Vec::new();
    for run in runs {
        let mut from = run.start;
        for other in others.iter().filter(|other| other.start < run.end && other.end > run.start) {
            if other.start > from {
                left.push(from..other.start);
            }
            from = from.max(other.end);
        }
        if run.end > from {
            left.push(from..run.end);
        }
    }
    left
}

/// Runs of rows away from a stop: so many before it and after it are not, nor is a run of fewer than the least.
fn away(on_stop: &[bool], [comes, settles]: [usize; 2], least: usize) -> Vec<Range<usize>> {
    let rows = on_stop.len();
    let mut free = Vec::new();
    let mut from = 0;
    for k in (0..rows).filter(|&k| on_stop[k]) {
        if k >= from + comes + least {
            free.push(from..k - comes);
        }
        from = k + 1 + settles;
    }
    if rows >= from + least {
        free.push(from..rows);
    }
    free
}

#[cfg(test)]
mod tests {
    use super::{away, without, worst};

    #[test]
    fn a_stop_takes_the_rows_around_it() {
        let mut on_stop = vec![false; 100];
        on_stop[30] = true;
        on_stop[31] = true;
        on_stop[60] = true;
        assert_eq!(away(&on_stop, [2, 5], 10), [0..28, 37..58, 66..100]);
        // what is too short to be worth it, and a stop that lasts to the end
        assert_eq!(away(&on_stop, [2, 5], 25), [0..28, 66..100]);
        on_stop[60..].fill(true);
        assert_eq!(away(&on_stop, [2, 5], 10), [0..28, 37..58]);
        assert_eq!(away(&[true; 20], [2, 5], 10), []);
    }

    #[test]
    fn gaps_divide_the_runs_that_they_are_in() {
        let gaps = worst(vec![50..55, 20..25, 24..30, 98..120]);
        assert_eq!(gaps, [20..30, 50..55, 98..120]);
        assert_eq!(without(&[0..40, 45..100], &gaps), [0..20, 30..40, 45..50, 55..98]);
        assert_eq!(without(&[22..28, 30..45], &[35..37, 44..50]), [22..28, 30..35, 37..44]);
    }
}
