//! Where a bearing rests on its friction: a table between two slews. What the platform is held by there hangs on less turning than the
//! logged rate's noise makes, so the log does not tell it.

use std::ops::Range;

use super::Record;
use super::anew::merged;

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

    /// Runs of rows in which the rate is nothing but noise, and until it slips again.
    fn rests(&self) -> Vec<Range<usize>> {
        let rows = [MEAN_S, LEAST_S].map(|time_s| self.inputs.rows_of(time_s));
        let period_s = self.inputs.period_s;
        rests(&self.inputs.rate_radps, self.rate_noise.rms_radps, SLIPS_RAD / period_s, rows)
    }
}

/// Runs of rows whose mean over a span is below the noise, on to where they sum up to what slips, and no shorter than the least.
fn rests(rate_radps: &[f64], noise_radps: f64, slips_radps: f64, [span, least]: [usize; 2]) -> Vec<Range<usize>> {
    let span = span.max(1);
    let sums = sums(rate_radps);
    let within = |end: &usize| (sums[*end] - sums[end - span]).abs() < noise_radps * span as f64;
    let mut rests = merged((span..sums.len()).filter(within).map(|end| end - span..end).collect());
    // what held it there holds it until it slips
    for rest in &mut rests {
        let sticks = |end: &usize| (sums[*end] - sums[rest.end]).abs() < slips_radps;
        rest.end = (rest.end..sums.len()).take_while(sticks).last().unwrap_or(rest.end);
    }
    rests = merged(rests);
    rests.retain(|rest| rest.len() >= least);
    rests
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

#[cfg(test)]
mod tests {
    use super::rests;

    #[test]
    fn what_hardly_turns_is_one_rest_and_what_turns_is_none() {
        // two rests, with a move between them that slips or does not
        let rate =
            |moves: f64| -> Vec<f64> { (0..1000).map(|k| if (400..500).contains(&k) { moves } else { 0.0 }).collect() };
        let of = |moves: f64| rests(&rate(moves), 1e-4, 2e-2, [20, 100]);
        let whole = 0..1000;
        assert_eq!(of(1.5e-4), std::slice::from_ref(&whole));
        assert_eq!(of(1.0), [0..400, 500..1000]);
        assert_eq!(rests(&[1.0; 1000], 1e-4, 2e-2, [20, 100]), []);
    }
}
