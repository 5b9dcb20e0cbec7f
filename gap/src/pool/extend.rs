//! What one more effect would bring to all logs together, by equations that are linear where they stand: its size
//! shared, or each log's own.

use nalgebra::{DMatrix, DVector};

use super::climb::{Fitted, coordinates, hypotheses};
use super::joint::{Joint, Local, solve};
use super::material::Material;
use super::parameters::{Parameter, Prior, Unit};
use crate::fit::{Hypothesis, Linear, Point};
use crate::judge::RARE_SHIFT;
use crate::library::{Candidate, apply};

/// One effect more.
#[derive(Debug, Clone)]
pub(super) struct Promise {
    pub(super) candidate: Candidate,
    /// Evidence over the set without it [nats].
    pub(super) gain: f64,
    /// Values to begin with.
    pub(super) values: Vec<f64>,
}

impl Promise {
    /// For a fit.
    pub(super) fn is_enough(&self) -> bool {
        self.candidate.is_promised(self.gain)
    }
}

/// Every way in which an effect may show, those of all logs.
pub(super) fn library(materials: &[Material]) -> Vec<Candidate> {
    let mut all: Vec<Candidate> = Vec::new();
    let highest = |material: &Material| material.problem.ceiling_nm.unwrap_or(0.0);
    let strongest = (0..materials.len()).max_by(|a, b| highest(&materials[*a]).total_cmp(&highest(&materials[*b])));
    for (log, material) in materials.iter().enumerate() {
        for candidate in &material.problem.candidates {
            // limits of the torque stand over what the log with the largest torque needed
            let lower = candidate.effect == "torque_saturation" && Some(log) != strongest;
            if !lower && !all.contains(candidate) {
                all.push(candidate.clone());
            }
        }
    }
    all
}

/// Every effect that a fitted set does not have, the best first.
pub(super) fn promises(materials: &[Material], fitted: &Fitted, library: &[Candidate]) -> Vec<Promise> {
    let others: Vec<&Candidate> =
        library.iter().filter(|candidate| !fitted.effects.names.contains(&candidate.effect)).collect();
    let all = hypotheses(materials, &fitted.effects);
    let wide: Vec<Local> = all
        .iter()
        .zip(materials)
        .zip(&fitted.points)
        .map(|((hypothesis, material), point)| with_probes(hypothesis, material, point, &others))
        .collect();
    let count = fitted.parameters.len();
    let before: Vec<usize> = (0..count).collect();
    let narrow: Vec<Local> = wide.iter().map(|local| local.of(&before)).collect();
    let evidence = |joint: &Joint| joint.volume - 0.5 * joint.cost;
    let Some(base) = solve(&narrow, &fitted.parameters, &fitted.own).map(|joint| evidence(&joint)) else {
        return Vec::new();
    };
    let mut first = count;
    let mut best: Vec<Promise> = Vec::new();
    for candidate in others {
        let probes: Vec<usize> = (first..first + candidate.probes.len()).collect();
        first += candidate.probes.len();
        let chosen: Vec<usize> = before.iter().chain(&probes).copied().collect();
        let locals: Vec<Local> =
            if probes.is_empty() { narrow.clone() } else { wide.iter().map(|local| local.of(&chosen)).collect() };
        let parameters = with_candidate(&fitted.parameters, &materials[0].problem.nuisances, candidate);
        let mut promise: Option<Promise> = None;
        for apart in [false, true] {
            let own: Vec<bool> = parameters
                .iter()
                .enumerate()
                .map(|(place, parameter)| match parameter.unit {
                    Unit::Effect(MORE) => apart,
                    _ => fitted.own[place],
                })
                .collect();
            let Some(joint) = solve(&locals, &parameters, &own) else { continue };
            let amplitudes = amplitudes(&joint, &locals, &parameters);
            if !candidate.holds_at(&amplitudes) {
                continue;
            }
            let times = if apart { materials.len() as f64 } else { 1.0 };
            let search = times * (candidate.siblings as f64).ln() + if apart { RARE_SHIFT } else { 0.0 };
            let gain = evidence(&joint) - base - search;
            if promise.as_ref().is_none_or(|promise| gain > promise.gain) {
                let values = if candidate.releases.is_empty() {
                    candidate.values(&amplitudes)
                } else {
                    vec![0.0; candidate.releases.len()]
                };
                promise = Some(Promise { candidate: candidate.clone(), gain, values });
            }
        }
        let Some(promise) = promise.filter(|promise| promise.gain.is_finite()) else { continue };
        match best.iter_mut().find(|other| other.candidate.effect == promise.candidate.effect) {
            Some(other) if other.gain < promise.gain => *other = promise,
            Some(_) => {}
            None => best.push(promise),
        }
    }
    best.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    best
}

/// Unit of the effect that is tried.
const MORE: usize = usize::MAX;

/// Parameters of a set with those of a candidate.
fn with_candidate(
    parameters: &[Parameter],
    nuisances: &[crate::library::Nuisance],
    candidate: &Candidate,
) -> Vec<Parameter> {
    let mut all = parameters.to_vec();
    for (release, (_, sigma)) in candidate.releases.iter().zip(&candidate.prior) {
        if let Some(place) = nuisances.iter().position(|nuisance| nuisance.name == *release) {
            let precision = sigma.max(nuisances[place].sigma).powi(-2);
            all[place].prior = Prior::Around { center: 0.0, precision };
            all[place].unit = Unit::Effect(MORE);
        }
    }
    all.extend(candidate.prior.iter().take(candidate.probes.len()).map(|(_, sigma)| Parameter {
        prior: Prior::Around { center: 0.0, precision: sigma.powi(-2) },
        any_scale: Some(*sigma),
        unit: Unit::Effect(MORE),
    }));
    all
}

/// Amplitudes of what was added, in the log that knows them best.
fn amplitudes(joint: &Joint, locals: &[Local], parameters: &[Parameter]) -> Vec<f64> {
    let added: Vec<usize> = (0..parameters.len()).filter(|&p| parameters[p].unit == Unit::Effect(MORE)).collect();
    let Some(&first) = added.first() else { return Vec::new() };
    let clear = |log: usize| joint.x[log][locals[log].begin.len() + first].abs() / joint.variance(log, first).sqrt();
    let clearest = (0..locals.len()).max_by(|a, b| clear(*a).total_cmp(&clear(*b))).unwrap_or(0);
    added.iter().map(|place| joint.x[clearest][locals[clearest].begin.len() + place]).collect()
}

/// A log's parabola with a column for each probe.
fn with_probes(hypothesis: &Hypothesis, material: &Material, point: &Point, candidates: &[&Candidate]) -> Local {
    let problem = &material.problem;
    let outcome = hypothesis.evaluate(point);
    let mut columns = hypothesis.sensitivities(point, &outcome.prediction);
    let probes = candidates.iter().flat_map(|candidate| {
        candidate.probes.iter().map(|(values, divisor)| {
            let mut variant = hypothesis.variant(point, usize::MAX);
            apply(candidate.effect, values, &mut variant.physics);
            (variant, *divisor)
        })
    });
    columns.extend(hypothesis.slopes(probes.collect(), &outcome.prediction));
    let (gram, drive): (DMatrix<f64>, DVector<f64>) = Linear::of(problem).joined(&columns, &outcome.residual);
    let at = coordinates(hypothesis, point);
    let count = drive.len();
    let at = DVector::from_fn(count, |place, _| if place < at.len() { at[place] } else { 0.0 });
    let begin = hypothesis.precision[..point.state.len()].to_vec();
    Local::new(at, begin, gram, &drive, outcome.square, material.asked.temper)
}
