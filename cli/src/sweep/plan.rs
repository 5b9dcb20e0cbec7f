//! What is run: which configuration run k has, from k alone.

use std::fmt::Write;

use gimbal_model_file::{ModelFile, Tolerance};
use gimbal_servo::{Config, Digest};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::Args;
use super::lanes;
use super::margin::margin;
use super::parameter::{PARAMETERS, Parameter};
use super::trial::Case;
use crate::exit::Failure;

/// Grid points where a range does not say.
const COUNT: u64 = 21;
/// Draws where nothing is said.
const DRAWS: u64 = 2000;
/// Draws are cut off here, in standard deviations.
const MOST_SIGMA: f64 = 4.0;

/// A parameter and its range.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    pub(super) parameter: &'static Parameter,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) count: u64,
}

/// How the parameters are chosen.
#[derive(Debug, Clone)]
pub(super) enum Design {
    Grid(Vec<Range>),
    Latin(Vec<Range>, u64),
    Draws(u64),
}

/// All runs.
pub(super) struct Plan {
    pub(super) config: Config,
    pub(super) tolerance: Tolerance,
    pub(super) case: Case,
    pub(super) accel_g: f64,
    pub(super) design: Design,
    seed: u64,
}

/// One run: its parameters and what it comes to; nothing where no law can be built.
pub(super) struct Run {
    number: u64,
    values: Vec<f64>,
    metrics: Option<[Option<f64>; 6]>,
}

/// Columns behind the parameters.
pub(super) const METRICS: [&str; 6] = [
    "saturation_g",
    "peak_gimbal_angle_rad",
    "peak_gyro_angle_rad",
    "velocity_error_mps",
    "phase_margin_deg",
    "limited",
];

impl Range {
    /// `NAME=FROM..TO[:COUNT]`
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}`: write NAME=FROM..TO or NAME=FROM..TO:COUNT, K=7..9:11 for example");
        let (name, range) = text.split_once('=').ok_or_else(wrong)?;
        let (range, count) = range.split_once(':').map_or((range, None), |(range, count)| (range, Some(count)));
        let (from, to) = range.split_once("..").ok_or_else(wrong)?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite()).ok_or_else(wrong);
        let (from, to) = (number(from)?, number(to)?);
        let count = count.map_or(Ok(COUNT), |count| count.trim().parse().map_err(|_| wrong()))?;
        if count == 0 || count > 10_000 {
            return Err(format!("`{text}`: write a count from 1 to 10000"));
        }
        let parameter = Parameter::find(name.trim()).ok_or_else(|| {
            let names: Vec<_> = PARAMETERS.iter().map(|parameter| parameter.name).collect();
            format!("`{name}` is not a parameter that can be varied; these are: {}", names.join(", "))
        })?;
        Ok(Self { parameter, from, to, count })
    }

    fn at(&self, share: f64) -> f64 {
        self.from + share * (self.to - self.from)
    }
}

impl Plan {
    pub(super) fn new(args: &Args, model: &ModelFile) -> Result<Self, Failure> {
        let design = match (&args.vary[..], args.latin) {
            ([], _) => Design::Draws(args.monte_carlo.unwrap_or(DRAWS)),
            (ranges, None) => Design::Grid(ranges.to_vec()),
            (ranges, Some(runs)) => Design::Latin(ranges.to_vec(), runs),
        };
        let plan = Self {
            config: model.config,
            tolerance: model.tolerance,
            case: args.case,
            accel_g: args.accel_g,
            design,
            seed: args.seed,
        };
        if plan.runs() == 0 || plan.runs() > 100_000_000 {
            return Err(Failure::input(format!("{} runs: write 1 to 100000000 of them", plan.runs())));
        }
        Ok(plan)
    }

    pub(super) fn runs(&self) -> u64 {
        match &self.design {
            Design::Grid(ranges) => ranges.iter().map(|range| range.count).fold(1, u64::saturating_mul),
            Design::Latin(_, runs) | Design::Draws(runs) => *runs,
        }
    }

    /// Parameters that differ between runs.
    pub(super) fn parameters(&self) -> Vec<&'static Parameter> {
        match &self.design {
            Design::Grid(ranges) | Design::Latin(ranges, _) => ranges.iter().map(|range| range.parameter).collect(),
            Design::Draws(_) => PARAMETERS.iter().collect(),
        }
    }

    pub(super) fn header(&self) -> String {
        let names = self.parameters();
        let names = names.iter().map(|parameter| parameter.name);
        std::iter::once("run").chain(names).chain(METRICS).collect::<Vec<_>>().join(",")
    }

    /// What tells this plan from every other, and this program from others.
    pub(super) fn fingerprint(&self) -> u64 {
        let Self { config, tolerance, case, accel_g, design, seed } = self;
        let told = |ranges: &[Range]| -> String {
            let told = ranges
                .iter()
                .map(|range| format!("{} {:?} {:?} {};", range.parameter.name, range.from, range.to, range.count));
            told.collect()
        };
        let design = match design {
            Design::Grid(ranges) => format!("grid {}", told(ranges)),
            Design::Latin(ranges, runs) => format!("latin {} {runs}", told(ranges)),
            Design::Draws(runs) => format!("draws {runs}"),
        };
        let (version, header) = (env!("CARGO_PKG_VERSION"), self.header());
        let mut digest = Digest::default();
        digest.add(
            format!("{version} {header} {config:?} {tolerance:?} {case:?} {accel_g:?} {design} {seed}").as_bytes(),
        );
        digest.value()
    }

    fn values(&self, run: u64) -> Vec<f64> {
        match &self.design {
            Design::Grid(ranges) => {
                let mut rest = run;
                let mut place = |range: &Range| {
                    let index = rest % range.count;
                    rest /= range.count;
                    let share = if range.count > 1 { index as f64 / (range.count - 1) as f64 } else { 0.5 };
                    range.at(share)
                };
                ranges.iter().map(&mut place).collect()
            }
            Design::Latin(ranges, runs) => {
                let mut random = self.random(run);
                let mut cell = |(dimension, range): (usize, &Range)| {
                    let index = shuffled(run, *runs, self.seed ^ (dimension as u64 + 1) << 32);
                    range.at((index as f64 + uniform(&mut random)) / *runs as f64)
                };
                ranges.iter().enumerate().map(&mut cell).collect()
            }
            Design::Draws(_) => {
                let mut random = self.random(run);
                let draw = |parameter: &Parameter| {
                    let sigma = parameter.tolerance(&self.tolerance);
                    let factor = 1.0 + sigma * normal(&mut random).clamp(-MOST_SIGMA, MOST_SIGMA);
                    parameter.get(&self.config) * factor.max(0.01)
                };
                PARAMETERS.iter().map(draw).collect()
            }
        }
    }

    /// One stream of random numbers a run.
    fn random(&self, run: u64) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(run);
        random
    }

    /// Does runs, at most [`lanes::LANES`] of them.
    pub(super) fn run(&self, runs: std::ops::Range<u64>) -> Vec<Run> {
        let parameters = self.parameters();
        let values: Vec<Vec<f64>> = runs.clone().map(|run| self.values(run)).collect();
        let configs: Vec<Config> = values.iter().map(|values| self.with(&parameters, values)).collect();
        let metrics = self.metrics(&configs);
        let numbered = runs.zip(values).zip(metrics);
        numbered.map(|((number, values), metrics)| Run { number, values, metrics }).collect()
    }

    fn with(&self, parameters: &[&Parameter], values: &[f64]) -> Config {
        let mut config = self.config;
        for (parameter, value) in parameters.iter().zip(values) {
            parameter.set(&mut config, *value);
        }
        config
    }

    /// Saturation limit, peaks, velocity error, phase margin, and whether the gyro met its stop at the plan's acceleration;
    /// nothing where no law can be built.
    pub(super) fn metrics(&self, configs: &[Config]) -> Vec<Option<[Option<f64>; 6]>> {
        let found = lanes::run(configs, self.case, self.accel_g);
        let told = configs.iter().zip(found).map(|(config, found)| {
            let (outcome, limit_g) = found.ok()?;
            Some([
                limit_g,
                Some(outcome.peak_gimbal_angle_rad),
                Some(outcome.peak_gyro_angle_rad),
                Some(outcome.velocity_error_mps),
                margin(config).map(|margin| margin.phase_deg),
                Some(if outcome.limited { 1.0 } else { 0.0 }),
            ])
        });
        told.collect()
    }
}

impl Run {
    /// The row of the result; empty where there is nothing.
    pub(super) fn csv(&self) -> String {
        let mut row = self.number.to_string();
        for value in &self.values {
            let _ = write!(row, ",{value:.9e}");
        }
        for index in 0..METRICS.len() {
            row.push(',');
            if let Some(value) = self.metrics.and_then(|metrics| metrics[index]) {
                let _ = write!(row, "{value:.9e}");
            }
        }
        row.push('\n');
        row
    }
}

/// In 0..1.
fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Of mean 0 and standard deviation 1, after Box and Muller.
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (size, angle) = (1.0 - uniform(random), uniform(random));
    (-2.0 * size.ln()).sqrt() * (2.0 * std::f64::consts::PI * angle).cos()
}

/// A place in `0..count` for each place, each once: four rounds after Feistel, walked on until inside.
fn shuffled(place: u64, count: u64, key: u64) -> u64 {
    let half_bits = (64 - count.saturating_sub(1).leading_zeros()).div_ceil(2).max(1);
    let mask = (1_u64 << half_bits) - 1;
    let mut at = place;
    loop {
        let (mut left, mut right) = (at >> half_bits, at & mask);
        for round in 0..4 {
            let mixed = mix(right ^ mix(key.wrapping_add(round)));
            (left, right) = (right, left ^ (mixed & mask));
        }
        at = left << half_bits | right;
        if at < count {
            return at;
        }
    }
}

/// The finaliser of `SplitMix64`.
fn mix(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    value ^ (value >> 31)
}

#[cfg(test)]
mod tests {
    use super::{Range, shuffled};

    #[test]
    fn closed_form_a_shuffle_gives_each_place_once() {
        for count in [1, 2, 7, 64, 1000] {
            let mut places: Vec<u64> = (0..count).map(|place| shuffled(place, count, 99)).collect();
            assert!(count < 64 || places.iter().zip(0..).filter(|(at, place)| **at == *place).count() < 10);
            places.sort_unstable();
            assert!(places.into_iter().eq(0..count));
        }
    }

    #[test]
    fn contract_ranges_are_read() {
        let range = Range::parse("K=7..9.5:11").expect("a range");
        assert_eq!((range.parameter.name, range.count), ("servo.gain_nm_per_rad_s", 11));
        assert!(Range::parse("gyro.stop_angle_rad=0.008..0.01").is_ok());
        for wrong in ["K", "K=7", "K=7..x", "K=7..9:0", "gain=7..9"] {
            assert!(Range::parse(wrong).is_err());
        }
    }
}
