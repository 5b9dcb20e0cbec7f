//! Where a bearing rests on its friction: a table between two slews. What the platform is held by there hangs on less turning than the
//! logged rate's noise makes, so the log does not tell it.

use std::ops::Range;

use super::Record;

/// Time over which the rate's mean is below its noise from row to row where the bearing rests [s].
const MEAN_S: f64 = 0.02;
/// Turning after which friction no longer hangs on where a rest has left it, several times what it follows over [rad].
const SLIPS_RAD: f64 = 2e-5;
/// Shortest rest that is left out [s].
const LEAST_S: f64 = 0.1;
/// Share of the rows that must be left.
const LEAST_MOVING: f64 = 0.4;

impl Record {
    /// The same with its rests left out, after each of which the platform begins anew; none where it has none or little else, or comes
    /// near a stop.
    pub(crate) fn without_rests(&self) -> Option<Self> {
        let rests = self.rests();
        let rows: usize = rests.iter().map(ExactSizeIterator::len).sum();
        let moving = self.rows() - rows;
        if self.comes_near_a_stop() || rests.is_empty() || (moving as f64) < LEAST_MOVING * self.rows() as f64 {
            return None;
        }
        let mut other = self.clone();
        other.notes.push(format!(
            "the bearing rests {} times, for {:.1} s, on friction that hangs on less turning than the logged rate tells: left out, \
             and the platform begins anew after each",
            rests.len(),
            rows as f64 * self.inputs.period_s
        ));
        other.does_not_know(rests);
        Some(other)
    }

    /// Runs of rows in which the rate is nothing but noise.
    fn rests(&self) -> Vec<Range<usize>> {
        let span = self.inputs.rows_of(MEAN_S).max(1);
        let most = self.rate_noise.rms_radps * span as f64;
        let sums = sums(&self.inputs.rate_radps);
        let within = |end: &usize| (sums[*end] - sums[end - span]).abs() < most;
        let mut rests: Vec<Range<usize>> = Vec::new();
        for end in (span..sums.len()).filter(within) {
            match rests.last_mut() {
                Some(last) if end - span <= last.end => last.end = end,
                _ => rests.push(end - span..end),
            }
        }
        // what held it there holds it until it slips
        let slips = SLIPS_RAD / self.inputs.period_s;
        for rest in &mut rests {
            let sticks = |end: &usize| (sums[*end] - sums[rest.end]).abs() < slips;
            rest.end = (rest.end..sums.len()).take_while(sticks).last().unwrap_or(rest.end);
        }
        rests.retain(|rest| rest.len() >= self.inputs.rows_of(LEAST_S));
        rests
    }
}

/// Sums of all values before each.
fn sums(values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let all = values.iter().map(|value| {
        sum += value;
        sum
    });
    [0.0].into_iter().chain(all).collect()
}
