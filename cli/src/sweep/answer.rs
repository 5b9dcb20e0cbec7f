//! What a sweep says: at how many g the platform saturates, and which part's tolerance decides that.

use std::fmt::Write;

use serde_json::{Value, json};

use super::plan::{Design, METRICS, Plan};
use super::trial::Case;

/// Percentiles that are told.
const PERCENT: [f64; 7] = [0.1, 1.0, 5.0, 50.0, 95.0, 99.0, 99.9];
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
    mean: f64,
    squares: f64,
    bins: Vec<u32>,
}

/// The result of a sweep.
pub(super) struct Answer {
    /// In the order of [`METRICS`].
    pub(super) spreads: Vec<Spread>,
    runs: u64,
    unbuilt: u64,
    limited: u64,
    /// Sums of each parameter, its square and its product with the limit, over runs with a limit.
    sums: Vec<[f64; 3]>,
    /// Each parameter's nominal value.
    references: Vec<f64>,
    keeps_grid: bool,
    /// Values and limit of the first runs, for a picture of a grid.
    pub(super) grid: Vec<(Vec<f64>, f64)>,
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

    fn deviation(&self) -> f64 {
        if self.count > 1 { (self.squares / (self.count - 1) as f64).sqrt() } else { 0.0 }
    }

    /// The value that a share of the runs lies below, to a bin.
    pub(super) fn percentile(&self, percent: f64) -> f64 {
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

    /// Each parameter's part of the limit's variance, and the change of the limit for one standard deviation of it [g];
    /// largest first. Parameters are drawn independently, so that parts add up to 1 but for curvature and chance.
    fn parts(&self, plan: &Plan) -> Vec<(&'static str, &'static str, f64, f64)> {
        let limit = &self.spreads[0];
        let count = limit.count as f64;
        let offset = limit.mean - limit.nominal.unwrap_or_default();
        let mut parts: Vec<_> = plan
            .parameters()
            .into_iter()
            .zip(&self.sums)
            .map(|(parameter, [sum, squares, products])| {
                let mean = sum / count;
                let variance = (squares / count - mean * mean).max(0.0);
                let covariance = products / count - mean * offset;
                let slope_g = if variance > 0.0 { covariance / variance.sqrt() } else { 0.0 };
                let whole = limit.squares / count;
                let share = if whole > 0.0 { slope_g * slope_g / whole } else { 0.0 };
                (parameter.symbol, parameter.name, share, slope_g)
            })
            .collect();
        parts.sort_by(|a, b| b.2.total_cmp(&a.2));
        parts
    }

    /// For people.
    pub(super) fn text(&self, plan: &Plan) -> String {
        let mut text = String::new();
        let limit = &self.spreads[0];
        let disturbed = match plan.case {
            Case::Unbalance => "unbalance alone",
            Case::Friction => "friction alone, rate of 0.1 rad/s reversed every 2 s",
            Case::Both => "unbalance and friction, rate of 0.1 rad/s reversed every 2 s",
        };
        match limit.nominal {
            Some(limit_g) => {
                let _ = writeln!(text, "the nominal platform saturates at {limit_g:.2} g for 5 s ({disturbed})");
            }
            None => {
                let _ = writeln!(text, "the nominal platform does not saturate within its range ({disturbed})");
            }
        }
        let draws = matches!(plan.design, Design::Draws(_));
        let parts = self.parts(plan);
        if let Some((symbol, name, share, slope_g)) = parts.first().filter(|_| draws && limit.count > 1) {
            let _ = writeln!(
                text,
                "the tolerance that decides it is that of {symbol} ({name}): {:.0} % of the limit's variance, {slope_g:+.2} g \
                 for one standard deviation",
                100.0 * share
            );
        }
        let _ = writeln!(
            text,
            "{} runs, seed and plan {:016x}; peaks and velocity error at {} g",
            self.runs,
            plan.fingerprint(),
            plan.accel_g
        );
        if self.unbuilt > 0 {
            let _ = writeln!(
                text,
                "{} runs have an unstable loop or a value out of range: their cells are empty",
                self.unbuilt
            );
        }
        let missing = self.runs - self.unbuilt - limit.count;
        if missing > 0 {
            let _ = writeln!(text, "{missing} runs do not saturate within the model's range");
        }
        let _ = writeln!(text, "{} of {} runs are on a stop at {} g", self.limited, self.runs, plan.accel_g);
        let _ = write!(text, "{:<24}{:>12}{:>12}", "", "nominal", "std");
        for percent in PERCENT {
            let _ = write!(text, "{percent:>11} %");
        }
        text.push('\n');
        for (name, spread) in METRICS.iter().zip(&self.spreads).take(5) {
            let _ = write!(text, "{name:<24}{:>12.5}{:>12.5}", spread.nominal.unwrap_or(f64::NAN), spread.deviation());
            for percent in PERCENT {
                let _ = write!(text, "{:>13.5}", spread.percentile(percent));
            }
            text.push('\n');
        }
        if draws {
            text.push_str("part of the limit's variance, and its change for one standard deviation:\n");
            for (symbol, name, share, slope_g) in parts.iter().filter(|part| part.2 > 0.005) {
                let _ = writeln!(text, "  {symbol:<10}{:>6.1} %{slope_g:>+9.3} g   {name}", 100.0 * share);
            }
        }
        text.truncate(text.trim_end().len());
        text
    }

    /// For programs.
    pub(super) fn json(&self, plan: &Plan) -> Value {
        let spreads: serde_json::Map<String, Value> = METRICS
            .iter()
            .zip(&self.spreads)
            .take(5)
            .map(|(name, spread)| {
                let percentiles: serde_json::Map<String, Value> =
                    PERCENT.iter().map(|percent| (percent.to_string(), json!(spread.percentile(*percent)))).collect();
                let value = json!({
                    "nominal": spread.nominal,
                    "runs": spread.count,
                    "mean": spread.mean,
                    "std": spread.deviation(),
                    "percentiles": percentiles,
                });
                ((*name).to_owned(), value)
            })
            .collect();
        let parts: Vec<Value> = self
            .parts(plan)
            .into_iter()
            .map(|(symbol, name, share, slope_g)| {
                json!({ "parameter": name, "symbol": symbol, "variance_share": share, "change_per_std_g": slope_g })
            })
            .collect();
        json!({
            "case": plan.case.name(),
            "accel_g": plan.accel_g,
            "runs": self.runs,
            "unbuilt": self.unbuilt,
            "limited": self.limited,
            "metrics": spreads,
            "decides": parts,
        })
    }
}
