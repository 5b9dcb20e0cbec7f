//! What would have been seen: the smallest size of each effect that is not there.

use gimbal_model_file::Tolerance;
use gimbal_plant::Effect;
use nalgebra::DVector;

use super::against::BEYOND;
use super::comb;
use super::decide::Decision;
use super::samples::least_stop_change;
use crate::fit::{Fit, Problem, solve};
use crate::library::DISPLACEMENT;
use crate::record::{Signal, peak_rad, plateau};

/// Standard errors at which an effect is named.
const SEEN: f64 = 7.0;
/// Stops that are tried, one over the next.
const NEARER: f64 = 0.99;
/// Power of d that grows evenly with the depth at which a limit cuts a peak off: the rms of what is above is
/// `depth^(5/4)`.
const DEPTH_POWER: f64 = 0.8;

/// Least share of the pick-off's noise that is not put down to its steps.
const LEAST_NOISE: f64 = 0.1;

/// Which sizes would have been named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// This one and larger ones.
    Above,
    /// This one and lower ones: a limit, or a stop that comes nearer.
    Below,
}

impl Seen {
    /// Name in the report.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Above => "above",
            Self::Below => "below",
        }
    }
}

/// The smallest size of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Detectable {
    /// Name.
    pub effect: &'static str,
    /// Name of its first parameter.
    pub parameter: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Size that would just have been named; none when this log cannot show the effect.
    pub size: Option<f64>,
    /// On which side of it others would have been.
    pub seen: Seen,
}

/// For every effect of the library.
#[must_use]
pub fn detectable(problem: &Problem, fit: &Fit, decision: &Decision, tolerance: &Tolerance) -> Vec<Detectable> {
    Effect::all()
        .filter(|effect| !problem.not_looked_for.contains(&effect.name()))
        .map(|effect| {
            let parameter = effect.parameters()[0];
            let (size, seen) = match effect.name() {
                "torque_saturation" => (ceiling_nm(problem, fit), Seen::Below),
                "stop_angle" => (nearer_stop(problem, tolerance, parameter.low), Seen::Below),
                "pickoff_quantisation" => (step_rad(problem, fit, decision), Seen::Above),
                _ => (smallest(problem, effect, tolerance), Seen::Above),
            };
            Detectable { effect: effect.name(), parameter: parameter.name, unit: parameter.unit, size, seen }
        })
        .collect()
}

/// Size of an effect whose columns tell it.
fn smallest(problem: &Problem, effect: Effect, tolerance: &Tolerance) -> Option<f64> {
    let sizes = problem.candidates.iter().enumerate().filter(|(_, candidate)| candidate.effect == effect.name());
    let sizes = sizes.filter_map(|(index, candidate)| {
        if let Some(release) = candidate.releases.first() {
            let place = problem.nuisance(release)?;
            let sigma = error(problem, index, Some(problem.columns.begin + place))?;
            let scale = if effect.name() == "mass_unbalance" {
                problem.nuisances[place].sigma / tolerance.of(effect.name())
            } else {
                1.0
            };
            return Some((SEEN * sigma).max(BEYOND * tolerance.of(effect.name()) * scale));
        }
        let sigma = error(problem, index, None)?;
        let secant = (candidate.probes[0].1 - 1.0).abs() < 1e-12 && candidate.probes[0].0[0] < 0.5;
        let informative = sigma < 0.5 * candidate.prior[0].1;
        informative.then(|| if secant { SEEN * sigma * candidate.probes[0].0[0] } else { SEEN * sigma })
    });
    // over less than that friction of a nominal platform may build up too
    let of_clamp = problem.nuisance(DISPLACEMENT).filter(|_| effect.name() == "presliding");
    let least = of_clamp.map_or(0.0, |place| problem.nuisances[place].tolerance);
    sizes.reduce(f64::min).map(|size| size.max(least))
}

/// Standard error of a column beside the nominal parameters and the beginning; the candidate's own first one if none is
/// given.
fn error(problem: &Problem, index: usize, place: Option<usize>) -> Option<f64> {
    let nothing = DVector::zeros(problem.gram.nrows());
    let (chosen, precision) = problem.chosen(&[index]);
    let place = place.unwrap_or(chosen.len() - problem.candidates[index].probes.len());
    Some(solve(&problem.gram, &nothing, &chosen, &precision)?.covariance[(place, place)].sqrt())
}

/// Highest limit of the torque that would have been seen, between those that were tried and the largest torque [N m].
///
/// ```text
/// d(limit) = 1 / error of the amplitude of its column = 7
/// ```
fn ceiling_nm(problem: &Problem, fit: &Fit) -> Option<f64> {
    let limits = problem.candidates.iter().enumerate().filter(|(_, candidate)| candidate.effect == "torque_saturation");
    let mut limits: Vec<(f64, f64)> = limits
        .filter_map(|(index, candidate)| {
            let sigma = error(problem, index, None)?;
            let known = 1.0 / (sigma * sigma) - 1.0 / candidate.prior[0].1.powi(2);
            Some((candidate.probes[0].0[0], known.max(0.0).sqrt().powf(DEPTH_POWER)))
        })
        .collect();
    limits.sort_by(|a, b| b.0.total_cmp(&a.0));
    let seen = SEEN.powf(DEPTH_POWER);
    let first = limits.iter().position(|(_, depth)| *depth >= seen)?;
    let (limit_nm, depth) = limits[first];
    let peak_nm = fit.prediction.motor_torque_nm.iter().fold(limit_nm, |peak, torque| peak.max(torque.abs()));
    let (higher_nm, less) = first.checked_sub(1).map_or((peak_nm, 0.0), |before| limits[before]);
    Some(limit_nm + (higher_nm - limit_nm) * (depth - seen) / (depth - less))
}

/// Relative change of the stop from which on the pick-off would have stood still on it.
fn nearer_stop(problem: &Problem, tolerance: &Tolerance, farthest: f64) -> Option<f64> {
    let least = least_stop_change(tolerance);
    let reached_rad = problem.record.plateau_rad.or_else(|| held_rad(problem, least, farthest))?;
    Some((reached_rad / problem.stop_rad - 1.0).min(-least))
}

/// The farthest of nearer stops on which the float would have stood [rad].
fn held_rad(problem: &Problem, least: f64, farthest: f64) -> Option<f64> {
    let theta_rad = &problem.record.channel(Signal::GyroAngle)?.values;
    // as white as the pick-off's own: third differences
    let noise_rad = |k: usize| match theta_rad.get(k.wrapping_sub(3)..=k) {
        Some(last) => (last[3] - 3.0 * last[2] + 3.0 * last[1] - last[0]) / 20.0_f64.sqrt(),
        None => 0.0,
    };
    let held = |stop_rad: f64| {
        let clipped = theta_rad.iter().map(|value| value.clamp(-stop_rad, stop_rad));
        let seen: Vec<f64> = clipped.enumerate().map(|(k, value)| value + noise_rad(k)).collect();
        plateau(&seen, problem.record.inputs.period_s, problem.stop_rad).is_some()
    };
    let first = peak_rad(theta_rad).min((1.0 - least) * problem.stop_rad);
    let last = (1.0 + farthest) * problem.stop_rad;
    let stops = std::iter::successors(Some(first), |stop_rad| Some(NEARER * stop_rad));
    stops.take_while(|stop_rad| *stop_rad >= last).find(|stop_rad| held(*stop_rad))
}

/// Step of the pick-off that would have stood out of its noise without the steps that were found [rad].
fn step_rad(problem: &Problem, fit: &Fit, decision: &Decision) -> Option<f64> {
    let theta = problem.record.channel(Signal::GyroAngle)?;
    let found = decision.found.iter().find(|found| found.effect == "pickoff_quantisation");
    let steps_rad = found.map_or(0.0, |found| comb::rough_rad(found.values[0]));
    let own = problem.noise[0].powi(2) - steps_rad * steps_rad;
    let noise_rad = own.max((LEAST_NOISE * problem.noise[0]).powi(2)).sqrt();
    comb::smallest_rad(&fit.prediction.gyro_angle_rad, &theta.valid, noise_rad)
}
