//! A simulated axis, its diagnosis, and whether that is right.

use std::path::Path as File;

use gimbal_gap::axis::{AxisDiagnosis, AxisLog, diagnose};
use gimbal_gap::judge::Verdict;
use gimbal_model_file::AxisModel;

use super::draw::{Axis, Group, group, rng};
use super::effect::Kind;
use super::run::{model, run};
use super::size::drawn;

/// How a diagnosis ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// No gap, and there is none.
    Quiet,
    /// A gap where there is none.
    Alarm,
    /// The effects of the axis and no other.
    Right,
    /// Not told apart: the effects of the axis are one of the sets that it gives.
    Class,
    /// The effects of the axis, and others.
    Extra,
    /// One of two, and no other.
    Part,
    /// Called unknown.
    Unknown,
    /// Called no gap.
    Missed,
    /// Anything else.
    Wrong,
}

/// One diagnosed axis.
#[derive(Debug)]
pub struct Scored {
    pub seed: u64,
    pub group: Group,
    pub axis: Axis,
    pub truth: Vec<&'static str>,
    pub told: Vec<(String, f64)>,
    pub verdict: Verdict,
    pub unknown: f64,
    pub alternatives: usize,
    pub outcome: Outcome,
    /// Errors of the first parameters in standard errors, where truth and report speak of the same.
    pub errors: Vec<(&'static str, f64)>,
    /// Share of the gap gone on blocks held out, and on another log of the axis.
    pub held_out: f64,
    pub unseen: Option<f64>,
    pub report: String,
    /// Sets by probability.
    pub sets: Vec<(String, f64)>,
}

/// The diagnosis of a seed's log, and of another log of the same axis with the fit to the first.
pub fn diagnosed(axis: &Axis, without: &[&str]) -> AxisDiagnosis {
    let mut model = AxisModel::parse(&model(axis), "axis.toml").expect("a model file").expect("an axis");
    model.known_good = without.iter().map(|name| (*name).to_owned()).collect();
    let read = |text: &str| AxisLog::read(text.as_bytes(), File::new("axis.csv"), &model).expect("a log");
    let first = run(axis, &axis.path, 101);
    let others = if axis.terms.is_empty() {
        Vec::new()
    } else {
        let path = axis.path.other(&mut rng(axis.seed, 5));
        vec![("other".to_owned(), read(&run(axis, &path, 102).text))]
    };
    diagnose(read(&first.text), &model, others)
}

/// What is named, once each, with its probability. A rate that the loop makes itself is late: that is no fault.
fn told(diagnosis: &AxisDiagnosis, axis: &Axis) -> Vec<(String, f64)> {
    let mut told: Vec<(String, f64)> = Vec::new();
    for found in &diagnosis.found {
        let own = found.effect == "velocity_delay" && found.shows_in == "control law" && !axis.velocity;
        if !own && !told.iter().any(|(name, _)| *name == found.effect) {
            told.push((found.effect.clone(), found.probability));
        }
    }
    told
}

fn outcome(truth: &[&str], told: &[(String, f64)], diagnosis: &AxisDiagnosis, group: Group) -> Outcome {
    let named = |name: &&&str| told.iter().any(|(other, _)| other == **name);
    let quiet = diagnosis.verdict == Verdict::NoGap || told.is_empty() && diagnosis.verdict != Verdict::Unexplained;
    let all = truth.iter().filter(named).count();
    let unknown = diagnosis.verdict == Verdict::Unexplained || diagnosis.unknown_probability > 0.5;
    if group == Group::None {
        return if quiet { Outcome::Quiet } else { Outcome::Alarm };
    }
    if quiet {
        return Outcome::Missed;
    }
    if unknown {
        return Outcome::Unknown;
    }
    if group == Group::Beyond {
        return Outcome::Wrong;
    }
    if !diagnosis.alternatives.is_empty() {
        let holds = |effects: &[String]| truth.iter().all(|name| effects.iter().any(|other| other == name));
        let own: Vec<String> = told.iter().map(|(name, _)| name.clone()).collect();
        let inside = (holds(&own) && own.len() == truth.len())
            || diagnosis.alternatives.iter().any(|set| holds(&set.effects) && set.effects.len() == truth.len());
        if inside {
            return Outcome::Class;
        }
    }
    match (all == truth.len(), told.len()) {
        (true, count) if count == truth.len() => Outcome::Right,
        (true, _) => Outcome::Extra,
        (false, count) if all > 0 && count == all => Outcome::Part,
        _ => Outcome::Wrong,
    }
}

/// True value of the first parameter of an effect, where the report's is defined alike.
fn value(axis: &Axis, kind: Kind) -> Option<f64> {
    let term = axis.terms.iter().find(|term| term.kind == kind)?;
    Some(match kind {
        Kind::Inertia => axis.inertia + term.size,
        Kind::Viscous => axis.viscous + term.size,
        Kind::Level => axis.coulomb + term.size,
        Kind::Constant
        | Kind::Asymmetry
        | Kind::Stribeck
        | Kind::Quadratic
        | Kind::FrictionDrift
        | Kind::ViscousDrift
        | Kind::BiasDrift
        | Kind::PositionFriction
        | Kind::Taper
        | Kind::Spring
        | Kind::Hysteresis
        | Kind::Ripple
        | Kind::MotorRipple
        | Kind::DeadZone
        | Kind::Lag
        | Kind::Load
        | Kind::LoadFriction
        | Kind::VelocityDelay
        | Kind::VelocityScale => term.size,
        _ => return None,
    })
}

fn errors(axis: &Axis, diagnosis: &AxisDiagnosis) -> Vec<(&'static str, f64)> {
    axis.terms
        .iter()
        .filter_map(|term| {
            let truth = value(axis, term.kind)?;
            let found = diagnosis.found.iter().find(|found| found.effect == term.kind.name())?;
            let first = found.parameters.first()?;
            (first.std > 0.0).then(|| (term.kind.name(), (first.value - truth) / first.std))
        })
        .collect()
}

/// The axis of a seed with one effect, by a library that lacks it: what it names then is wrong, whatever it is.
pub fn without_its_family(seed: u64) -> Option<Scored> {
    let axis = drawn(seed)?;
    let kind = axis.terms.first()?.kind;
    // parameters and columns cannot be taken out
    let fixed = [Kind::Inertia, Kind::Viscous, Kind::Level, Kind::Scale];
    let columns = [Kind::VelocityDelay, Kind::VelocityScale, Kind::TorqueSign];
    if fixed.contains(&kind) || columns.contains(&kind) {
        return None;
    }
    let name = kind.name();
    Some(judged(seed, Group::Beyond, axis, &[name.split(':').next().unwrap_or(name)]))
}

/// Everything for one seed.
pub fn scored(seed: u64) -> Option<Scored> {
    drawn(seed).map(|axis| judged(seed, group(seed), axis, &[]))
}

/// An axis diagnosed and held against its truth; effects that the library shall lack.
pub fn judged(seed: u64, group: Group, axis: Axis, without: &[&str]) -> Scored {
    let diagnosis = diagnosed(&axis, without);
    let mut truth: Vec<&'static str> = axis.terms.iter().map(|term| term.kind.name()).collect();
    truth.dedup();
    let told = told(&diagnosis, &axis);
    let outcome = outcome(&truth, &told, &diagnosis, group);
    Scored {
        seed,
        group,
        errors: errors(&axis, &diagnosis),
        axis,
        truth,
        told,
        verdict: diagnosis.verdict,
        unknown: diagnosis.unknown_probability,
        alternatives: diagnosis.alternatives.len(),
        outcome,
        held_out: diagnosis.shrunk.first().map_or(0.0, |s| s.reduction_percent),
        unseen: diagnosis.shrunk.iter().find(|s| s.name.contains("other, not fitted")).map(|s| s.reduction_percent),
        sets: diagnosis.ranking.iter().map(|set| (set.effects.join(" + "), set.probability)).collect(),
        report: gimbal_gap::axis::text(&diagnosis),
    }
}
