//! A beat of what is left: a line over time that the motion does not have. A fan, a pump or a neighbour's machine pushes in
//! time, whatever the axis does; no effect of an axis' own does so.
//!
//! ```text
//! over = P(f) / median of P about f        P: power of the residual over all of the log, by Hann's window
//! ```

use realfft::RealFftPlanner;

use super::motion::Motion;
use crate::window::hann;

/// Lines to either side whose median is what is there without a beat, and lines that a beat takes to either side.
const ABOUT: usize = 40;
const OWN: usize = 3;
/// A beat from this power over its neighbours on: of ten thousand lines of noise the highest has about 14.
const STANDS_OUT: f64 = 100.0;
/// The motion has a line there from this power over its neighbours on.
const MOVES: f64 = 10.0;
/// Share of what is left that a beat takes at least.
const LEAST_SHARE: f64 = 0.05;
/// Periods in the log at least: slower ones are drift.
const PERIODS: usize = 12;
/// Frequencies of the mains and twice them, and how near to them a line is the mains' [Hz].
const MAINS_HZ: [f64; 4] = [50.0, 60.0, 100.0, 120.0];
const NEAR_HZ: f64 = 0.5;
/// Share of the rows about which the rate stays what it is, for so long and to that share of itself, from which on waves of
/// place are lines in time.
const EVEN_RATE: f64 = 0.4;
const STAYS_S: f64 = 0.25;
const STAYS: f64 = 0.05;

/// A line in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beat {
    /// [Hz].
    pub(super) hz: f64,
    /// Share of the power of what is left.
    pub(super) share: f64,
}

/// The strongest beat of a residual on the grid.
pub(super) fn beat(motion: &Motion, residual: &[f64]) -> Option<Beat> {
    if motion.stands || at_even_rate(motion) {
        return None;
    }
    let left = Lines::new(motion, residual);
    let of = |function: &dyn Fn(usize) -> f64| {
        Lines::new(motion, &motion.rows.iter().map(|&row| function(row)).collect::<Vec<_>>())
    };
    let needed = of(&|row| motion.needed[row]);
    let even = [of(&|row| motion.v[row].abs()), of(&|row| motion.needed[row].abs())];
    // the loop answers a force with a motion that needs less of it
    let driven = |line: usize| {
        needed.over(line) > MOVES && needed.own(line) > left.own(line) || even.iter().any(|own| own.over(line) > MOVES)
    };
    let all: f64 = left.power.iter().sum::<f64>().max(1e-300);
    (PERIODS..left.power.len())
        .filter(|&line| left.over(line) > STANDS_OUT)
        .map(|line| (line, left.own(line) / all))
        .filter(|(line, share)| *share > LEAST_SHARE && !of_mains(*line as f64 * left.step_hz))
        .filter(|(line, _)| !driven(*line))
        .max_by(|a, b| left.power[a.0].total_cmp(&left.power[b.0]))
        .map(|(line, share)| Beat { hz: line as f64 * left.step_hz, share })
}

fn of_mains(hz: f64) -> bool {
    MAINS_HZ.iter().any(|mains| (hz - mains).abs() < NEAR_HZ)
}

/// Whether the axis goes on at its rate, one or another, much of the time.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
fn at_even_rate(motion: &Motion) -> bool {
    let half = (0.5 * STAYS_S / motion.period_s) as usize;
    let stays = |row: usize| {
        let [from, to] = [row.saturating_sub(half), row + half].map(|row| motion.v.get(row).copied().unwrap_or(0.0));
        (to - from).abs() < STAYS * motion.v[row].abs()
    };
    let even = motion.rows.iter().filter(|&&row| stays(row)).count();
    even as f64 > EVEN_RATE * motion.rows.len() as f64
}

/// Power of a signal on the grid over frequency; rows that do not count are zero.
struct Lines {
    step_hz: f64,
    power: Vec<f64>,
}

impl Lines {
    fn new(motion: &Motion, values: &[f64]) -> Self {
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let mut even = motion.in_time(values.iter().map(|value| value - mean));
        let length = even.len();
        even.iter_mut().zip(hann(length)).for_each(|(value, window)| *value *= window);
        let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
        let mut lines = transform.make_output_vec();
        let power = match transform.process(&mut even, &mut lines) {
            Ok(()) => lines.iter().map(realfft::num_complex::Complex::norm_sqr).collect(),
            Err(_) => vec![0.0; lines.len()],
        };
        Self { step_hz: 1.0 / (length as f64 * motion.grid_s()), power }
    }

    /// Power of a line with those that its window spreads it over.
    fn own(&self, line: usize) -> f64 {
        self.power[line.saturating_sub(OWN)..(line + OWN + 1).min(self.power.len())].iter().sum()
    }

    /// Power of a line over that of its neighbours.
    fn over(&self, line: usize) -> f64 {
        let (from, to) = (line.saturating_sub(ABOUT), (line + ABOUT + 1).min(self.power.len()));
        let about = (from..to).filter(|other| other.abs_diff(line) > OWN).map(|other| self.power[other]);
        let mut about: Vec<f64> = about.collect();
        if about.is_empty() {
            return 0.0;
        }
        let middle = about.len() / 2;
        let (_, median, _) = about.select_nth_unstable_by(middle, f64::total_cmp);
        self.power[line] / median.max(1e-300)
    }
}
