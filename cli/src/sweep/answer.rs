//! What the runs of a sweep come to, in constant memory: each metric's spread, and what each parameter does to the limit.

use super::parameter::Parameter;
use super::plan::{Design, Plan};

/// Width and number of the bins that percentiles are read from, relative to the nominal value.
const BIN: f64 = 1e-4;
const BINS: usize = 40_000;

/// A metric over all runs, in constant memory.
#[derive(Debug, Clone)]
pub(super) struct Spread {
    pub(super) nominal: Option<f64>,
    pub(super) count: u64,
    least: f64,
    most: f64,
    pub(super) mean: f64,
    squares: f64,
    bins: Vec<u32>,
}

/// The result of a sweep.
pub(super) struct Answer {
    /// In the order of `METRICS`.
    pub(super) spreads: Vec<Spread>,
    runs: u64,
    pub(super) unbuilt: u64,
    pub(super) limited: u64,
    /// Sums of each parameter, its square and its product with the limit, over runs with a limit.
    sums: Vec<[f64; 3]>,
    /// Each parameter's nominal value.
    references: Vec<f64>,
    keeps_grid: bool,
    /// Values and limit of the first runs, for a picture of a grid.
    pub(super) grid: Vec<(Vec<f64>, f64)>,
}

/// What a parameter does to the limit. Parameters are drawn independently, so that shares add up to 1 but for curvature and
/// chance.
pub(super) struct Part {
    pub(super) parameter: &'static Parameter,
    /// Of the limit's variance.
    pub(super) share: f64,
    /// Standard deviation of the share, from the number of runs.
    pub(super) scatter: f64,
    /// Change of the limit for one standard deviation of the parameter [g].
    pub(super) slope_g: f64,
}

/// The most grid points that a picture shows.
const MOST_DRAWN: usize = 250_000;

impl Spread {
    fn new(nominal: Option<f64>) -> Self {
        let (least, most) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { nominal, count: 0, least, most, mean: 0.0, squares: 0.0, bins: vec![0; BINS] }
    }

    fn unit(&self) -> f64 {
        self.nominal.filter(|nominal| *nominal != 0.0).unwrap_or(1.0) * BIN
    }

    fn take(&mut self, value: f64) {
        self.count += 1;
        self.least = self.least.min(value);
        self.most = self.most.max(value);
        let step = value - self.mean;
        self.mean += step / self.count as f64;
        self.squares += step * (value - self.mean);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates at both ends")]
        let bin = (value / self.unit()) as usize;
        self.bins[bin.min(BINS - 1)] += 1;
    }

    pub(super) fn deviation(&self) -> f64 {
        if self.count > 1 { (self.squares / (self.count - 1) as f64).sqrt() } else { 0.0 }
    }

    /// The value that a share of the runs lies below, to a bin; not a number where there is no run.
    pub(super) fn percentile(&self, percent: f64) -> f64 {
        if self.count == 0 {
            return f64::NAN;
        }
        let wanted = percent / 100.0 * self.count as f64;
        let mut below = 0.0;
        for (bin, &count) in self.bins.iter().enumerate() {
            let count = f64::from(count);
            if count > 0.0 && below + count >= wanted {
                let value = (bin as f64 + ((wanted - below) / count).clamp(0.0, 1.0)) * self.unit();
                return value.clamp(self.least, self.most);
            }
            below += count;
        }
        self.most
    }
}

impl Answer {
    /// No run yet.
    pub(super) fn new(plan: &Plan) -> Self {
        let nominal = plan.metrics(&[plan.config]).into_iter().next().flatten().unwrap_or([None; 6]);
        let references: Vec<f64> = plan.parameters().into_iter().map(|parameter| parameter.get(&plan.config)).collect();
        Self {
            spreads: nominal.map(Spread::new).to_vec(),
            runs: 0,
            unbuilt: 0,
            limited: 0,
            sums: vec![[0.0; 3]; references.len()],
            references,
            keeps_grid: matches!(plan.design, Design::Grid(_)),
            grid: Vec::new(),
        }
    }

    /// Runs so far.
    pub(super) fn runs(&self) -> u64 {
        self.runs
    }

    /// Takes a row of the result.
    pub(super) fn take(&mut self, row: &str) {
        let cells: Vec<Option<f64>> = row.split(',').skip(1).map(|cell| cell.parse().ok()).collect();
        let (values, metrics) = cells.split_at(self.references.len().min(cells.len()));
        self.runs += 1;
        self.unbuilt += u64::from(metrics.iter().all(Option::is_none));
        self.limited += u64::from(metrics.last().copied().flatten().is_some_and(|limited| limited > 0.5));
        for (spread, value) in self.spreads.iter_mut().zip(metrics) {
            if let Some(value) = value {
                spread.take(*value);
            }
        }
        let limit = metrics.first().copied().flatten();
        if self.keeps_grid && self.grid.len() < MOST_DRAWN {
            self.grid.push((values.iter().flatten().copied().collect(), limit.unwrap_or(f64::NAN)));
        }
        if let Some(limit) = limit {
            let off_limit = limit - self.spreads[0].nominal.unwrap_or_default();
            for ((sum, value), reference) in self.sums.iter_mut().zip(values).zip(&self.references) {
                let off = value.unwrap_or_default() / reference - 1.0;
                *sum = [sum[0] + off, sum[1] + off * off, sum[2] + off * off_limit];
            }
        }
    }

    /// What each parameter does to the limit, the largest first.
    pub(super) fn parts(&self, plan: &Plan) -> Vec<Part> {
        let limit = &self.spreads[0];
        let count = limit.count as f64;
        let offset = limit.mean - limit.nominal.unwrap_or_default();
        let part = |(parameter, [sum, squares, products]): (&'static Parameter, &[f64; 3])| {
            let mean = sum / count;
            let variance = (squares / count - mean * mean).max(0.0);
            let covariance = products / count - mean * offset;
            let slope_g = if variance > 0.0 { covariance / variance.sqrt() } else { 0.0 };
            let whole = limit.squares / count;
            let share = if whole > 0.0 { slope_g * slope_g / whole } else { 0.0 };
            // A squared correlation r^2 of n draws scatters by 2 r (1 - r^2)/sqrt(n).
            let scatter = 2.0 * share.sqrt() * (1.0 - share) / count.sqrt();
            Part { parameter, share, scatter, slope_g }
        };
        let mut parts: Vec<Part> = plan.parameters().into_iter().zip(&self.sums).map(part).collect();
        parts.sort_by(|a, b| b.share.total_cmp(&a.share));
        parts
    }
}
