//! One run of the paper's 10 s through the flight code, and what matters of it.

use clap::ValueEnum;
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use gimbal_servo::{BuildError, Config, Input, Interpolation, Law, Stop};

use crate::run::profile::Profile;

/// What disturbs the platform while it is accelerated for 5 s of the 10.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Case {
    /// The unbalance alone: figures 7 and 8
    Unbalance,
    /// The bearings alone, rate of 0.1 rad/s reversed every 2 s: figures 9 and 10
    Friction,
    /// Both
    Both,
}

/// The acceleration of the profiles [g].
pub(super) const PROFILE_G: f64 = 20.0;

/// What a run comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) peak_gimbal_angle_rad: f64,
    pub(crate) peak_gyro_angle_rad: f64,
    pub(crate) velocity_error_mps: f64,
    /// Whether the gyro met a stop.
    pub(crate) limited: bool,
}

impl Case {
    /// Name in results.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Unbalance => "unbalance",
            Self::Friction => "friction",
            Self::Both => "both",
        }
    }

    /// The axis with what the case leaves out taken away; the rows are held.
    pub(crate) fn config(self, config: &Config) -> Config {
        let mut config = match self {
            Self::Unbalance => config.without_friction(),
            Self::Friction => config.without_unbalance(),
            Self::Both => *config,
        };
        config.interpolation = Interpolation::Held;
        config
    }

    /// Row `k` at an acceleration.
    pub(crate) fn row(self, accel_g: f64, k: u32, period_s: f64) -> Input<f64> {
        let profile = if self == Self::Unbalance { Profile::Unbalance } else { Profile::Friction };
        let row = profile.row(k, period_s);
        // The profile's own acceleration keeps its bits.
        #[allow(clippy::float_cmp, reason = "the very value")]
        let factor = if accel_g == PROFILE_G { 1.0 } else { accel_g / PROFILE_G };
        Input { accel_y_mps2: row.accel_y_mps2 * factor, ..row }
    }
}

/// Runs a case; `config` is the whole axis.
pub(crate) fn run(config: &Config, case: Case, accel_g: f64) -> Result<Outcome, BuildError> {
    let law: Law<f32> = case.config(config).build()?;
    Ok(run_law(&law, case, accel_g, config.period_s))
}

/// Runs a law that was built for the case.
pub(crate) fn run_law(law: &Law<f32>, case: Case, accel_g: f64, period_s: f64) -> Outcome {
    let mut state = law.start();
    let (mut peak_phi, mut peak_theta, mut limited) = (0.0_f32, 0.0_f32, false);
    for (row, rows) in Spans::new(case, accel_g, period_s) {
        let row = law.units().input(&row);
        for _ in 0..rows {
            let output = law.step(&mut state, row);
            peak_phi = peak_phi.max(output.gimbal_angle_rad.abs());
            peak_theta = peak_theta.max(output.gyro_angle_rad.abs());
            limited |= output.stop != Stop::Free;
        }
    }
    let [x, y] = law.velocity_error_mps(&state);
    Outcome {
        peak_gimbal_angle_rad: f64::from(peak_phi),
        peak_gyro_angle_rad: f64::from(peak_theta),
        velocity_error_mps: x.hypot(y),
        limited,
    }
}

/// The rows of a case as spans of equal rows.
pub(crate) struct Spans {
    case: Case,
    accel_g: f64,
    period_s: f64,
    next: u32,
}

impl Spans {
    pub(crate) fn new(case: Case, accel_g: f64, period_s: f64) -> Self {
        Self { case, accel_g, period_s, next: 0 }
    }
}

impl Iterator for Spans {
    type Item = (Input<f64>, u32);

    fn next(&mut self) -> Option<Self::Item> {
        let len = Profile::len(self.period_s);
        let row = |k| self.case.row(self.accel_g, k, self.period_s);
        let first = self.next;
        if first >= len {
            return None;
        }
        let start = row(first);
        self.next = (first + 1..len).find(|&k| row(k) != start).unwrap_or(len);
        Some((start, self.next - first))
    }
}

/// The acceleration at which the gyro just meets its stop [g]; none within the range of the configuration.
///
/// The gyro is free up to its first contact, so that a run with its stops far away tells by its largest theta how far
/// it is from them: a smooth function of the acceleration, whose root takes a few runs (regula falsi, after Illinois).
pub(crate) fn saturation_g(config: &Config, case: Case) -> Result<Option<f64>, BuildError> {
    let (law, stop_rad) = free_law(config, case)?;
    let mut root = Root::new(config.range.radial_accel_mps2 / STANDARD_GRAVITY_MPS2);
    while let Some(accel_g) = root.asks() {
        let outcome = run_law(&law, case, accel_g, config.period_s);
        root.take(outcome.peak_gyro_angle_rad / stop_rad - 1.0);
    }
    Ok(root.found())
}

/// A law whose stops are out of reach, and where they were.
pub(crate) fn free_law(config: &Config, case: Case) -> Result<(Law<f32>, f64), BuildError> {
    let mut free = case.config(config);
    let stop_rad = free.gyro.stop_angle_rad;
    free.gyro.stop_angle_rad = 1e3;
    Ok((free.build()?, stop_rad))
}

/// The root of a rising function between 0 and a largest argument, one question at a time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Root {
    most: f64,
    below: Option<(f64, f64)>,
    above: Option<(f64, f64)>,
    asked: f64,
    last_below: bool,
    count: u32,
    found: Option<f64>,
    over: bool,
}

impl Root {
    /// Relative accuracy of the root, about that of f32 through the run.
    const ACCURACY: f64 = 2e-6;
    const MOST_QUESTIONS: u32 = 24;

    pub(crate) fn new(most: f64) -> Self {
        let (below, above) = (None, None);
        Self { most, below, above, asked: 0.5 * most, last_below: false, count: 0, found: None, over: false }
    }

    /// The argument at which the function is wanted; none when it is over.
    pub(crate) fn asks(&self) -> Option<f64> {
        (!self.over).then_some(self.asked)
    }

    /// The root, if there is one.
    pub(crate) fn found(&self) -> Option<f64> {
        self.found
    }

    /// Takes the function's value at what was asked.
    pub(crate) fn take(&mut self, value: f64) {
        self.count += 1;
        if self.over {
            return;
        }
        let here = (self.asked, value);
        let is_below = value < 0.0;
        // The end that stays twice is given half its weight.
        let repeated = self.count > 2 && is_below == self.last_below;
        let halved = |end: &mut Option<(f64, f64)>| {
            if let Some((_, value)) = end.as_mut().filter(|_| repeated) {
                *value *= 0.5;
            }
        };
        if is_below {
            halved(&mut self.above);
            self.below = Some(here);
        } else {
            halved(&mut self.below);
            self.above = Some(here);
        }
        self.last_below = is_below;
        let before = self.asked;
        self.asked = match (self.below, self.above) {
            #[allow(clippy::float_cmp, reason = "the very value")]
            (Some((at, _)), None) if at == self.most => {
                self.over = true;
                return;
            }
            (Some(_), None) => self.most,
            (None, Some((at, _))) => {
                if at < 1e-3 * self.most {
                    (self.found, self.over) = (Some(0.0), true);
                    return;
                }
                0.25 * at
            }
            (Some((low, low_value)), Some((high, high_value))) => {
                low - low_value * (high - low) / (high_value - low_value)
            }
            (None, None) => self.asked,
        };
        let settled = (self.asked - before).abs() <= Self::ACCURACY * self.asked;
        if self.below.is_some() && self.above.is_some() && (settled || self.count >= Self::MOST_QUESTIONS) {
            (self.found, self.over) = (Some(self.asked), true);
        }
    }
}

#[cfg(test)]
mod tests {
    use gimbal_servo::Config;

    use super::{Case, Root, run, saturation_g};

    #[test]
    fn closed_form_roots_are_found_and_missing_ones_told() {
        for (function, root) in [
            ((|x| x * x / 400.0 - 1.0) as fn(f64) -> f64, Some(20.0)),
            (|x| x / 40.0 - 1.0, Some(40.0)),
            (|x| x / 60.0 - 1.0, None),
            (|x| x + 1.0, Some(0.0)),
        ] {
            let mut search = Root::new(50.0);
            while let Some(at) = search.asks() {
                search.take(function(at));
            }
            assert_eq!(search.found().is_some(), root.is_some());
            let (found, root) = (search.found().unwrap_or_default(), root.unwrap_or_default());
            assert!((found - root).abs() < 1e-4, "{found} for {root}");
        }
    }

    /// theta is linear in the unbalance torque: the limit is 20 g times stop over theta at 20 g. Just below it the gyro
    /// is free, just above it is not.
    #[test]
    fn closed_form_the_unbalance_saturates_in_proportion() {
        let config = Config::consistent();
        let at_20 = run(&config, Case::Unbalance, 20.0).expect("a preset");
        let expected = 20.0 * config.gyro.stop_angle_rad / at_20.peak_gyro_angle_rad;
        for case in [Case::Unbalance, Case::Friction, Case::Both] {
            let limit_g = saturation_g(&config, case).expect("a preset").expect("a limit");
            if case == Case::Unbalance {
                assert!((limit_g / expected - 1.0).abs() < 1e-5, "{limit_g} for {expected}");
            }
            assert!(!run(&config, case, limit_g * 0.9999).expect("a preset").limited, "{case:?} {limit_g}");
            assert!(run(&config, case, limit_g * 1.0001).expect("a preset").limited, "{case:?} {limit_g}");
        }
    }
}
