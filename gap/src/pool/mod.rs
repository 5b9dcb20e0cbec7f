//! Several logs of one platform fitted together: one verdict from all of them, what they share and what drifts from run
//! to run, and how far the correction goes on a log that it was not made from.
//!
//! ```text
//! r_l(x) ~ r_l - B_l (x - a_l)        each log about where it stands, under its own noise
//! cost   = sum over the logs of |r_l|^2 / t_l + priors        t_l: what the log's own best fit leaves over its noise
//! ```
//!
//! The nominal parameters and the effects belong to the platform: one value for all logs, whose prior counts once, unless
//! the evidence is higher with a value for each. The beginning is each log's own. Verdict and probabilities come from the
//! evidence of these fits by the rules for one log ([`crate::judge`]); an effect that no log shows by itself is named
//! where all of them show it.

mod climb;
mod extend;
mod joint;
mod material;
mod parameters;
mod read_off;
mod remains;
mod repeats;
mod set;
mod sharing;
mod shortlist;
pub(crate) mod told;
mod unseen;
mod values;
mod weigh;

use gimbal_model_file::ModelFile;

use crate::diagnose::Diagnosis;
use crate::judge::{Probabilities, SetProbability, UNEXPLAINED, Verdict, Weighed, Yardstick, best, rivals};
use climb::Fitted;
use material::Material;
use parameters::Unit;
pub use repeats::Repeat;
pub use values::Shared;

/// A set of effects over all logs.
#[derive(Debug, Clone, PartialEq)]
pub struct PooledSet {
    /// Names; none is the nominal model.
    pub effects: Vec<&'static str>,
    /// Over all logs.
    pub probability: f64,
    /// Evidence over the nominal parameters, less what speaks against it [nats].
    pub nats: f64,
    /// What it must bring to be named [nats].
    pub cost: f64,
    /// Whether it was fitted; else only the linear equations were looked at.
    pub is_fitted: bool,
}

/// What a log has of the fit to all logs: squares over the noise that its own best fit leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct LogFit {
    /// Its place.
    pub log: usize,
    /// Samples that count.
    pub samples: usize,
    /// With the nominal parameters alone.
    pub before: f64,
    /// With the set that is named.
    pub after: f64,
}

/// All logs together.
#[derive(Debug, Clone)]
pub struct Pool {
    /// Logs that serve.
    pub logs: Vec<usize>,
    /// Verdict over them.
    pub verdict: Verdict,
    /// Effects that are named.
    pub named: Vec<&'static str>,
    /// Sets, the most probable first.
    pub sets: Vec<PooledSet>,
    /// What else it may be: the rest of the class that cannot be told apart.
    pub alternatives: Vec<SetProbability>,
    /// That none of them is it.
    pub unknown_probability: f64,
    /// Parameters of the set that is named, or of the likeliest one where that cannot be told.
    pub shared: Vec<Shared>,
    /// Nominal parameters that are no effect and drift from run to run.
    pub drifting: Vec<Shared>,
    /// What each log has of the joint fit.
    pub fits: Vec<LogFit>,
    /// Each log under the model corrected from the others.
    pub unseen: Vec<(usize, Vec<Yardstick>)>,
    /// Pairs of logs under equal inputs.
    pub repeats: Vec<Repeat>,
    /// Remarks.
    pub notes: Vec<String>,
}

/// Takes diagnoses of several logs together.
#[must_use]
pub fn pool(diagnoses: &[Diagnosis], model: &ModelFile) -> Pool {
    pool_step_by_step(diagnoses, model, || ())
}

/// The same, telling of every set and log that is done.
#[must_use]
pub fn pool_step_by_step(diagnoses: &[Diagnosis], model: &ModelFile, mut step: impl FnMut()) -> Pool {
    let mut materials: Vec<Material> = Vec::new();
    for (log, diagnosis) in diagnoses.iter().enumerate() {
        materials.extend(Material::new(log, diagnosis, model));
        step();
    }
    let logs: Vec<usize> = materials.iter().map(|material| material.log).collect();
    let repeats = repeats::repeats(&logs, diagnoses);
    let read_off = read_off::read_off(diagnoses, &logs);
    let Some(found) = shortlist::found(&mut materials, diagnoses, &model.tolerance, &mut step) else {
        return refused(logs, repeats);
    };
    let weighed = weigh::weigh(&materials, &found.null, &found.fits, &found.promises, &model.tolerance);
    let best = best(&weighed, |set| set.nats - set.cost);
    let fit = best.and_then(|set| set.fit).map_or(&found.null, |index| &found.fits[index]);
    let names = |log: &usize| diagnoses[*log].decision.as_ref().is_some_and(|own| !own.found.is_empty());
    let explained: Vec<usize> = logs.iter().copied().filter(names).collect();
    let remains = remains::remains(&materials, &found.null, fit, &explained);
    step();
    // what a log shows no effect for by itself is still there where none is found for all of them
    let alone = |log: &usize| match &diagnoses[*log].decision {
        Some(own) if own.verdict == Verdict::Unexplained => own.unknown_probability,
        _ => 0.0,
    };
    let least = if best.is_none() { logs.iter().map(alone).fold(0.0, f64::max) } else { 0.0 };
    let unknown_probability = remains.unknown.max(least);
    let ranking = Probabilities::new(&weighed).ranking(&weighed, 1.0 - unknown_probability);
    let mut alternatives = Vec::new();
    let verdict = match best {
        Some(_) if unknown_probability > UNEXPLAINED[1] => Verdict::Unexplained,
        Some(_) if remains.tells => Verdict::PartlyExplained,
        Some(set) => {
            alternatives = rivals(&ranking, &set.effects);
            if alternatives.is_empty() { Verdict::Explained } else { Verdict::CannotTell }
        }
        None if unknown_probability > UNEXPLAINED[0] => Verdict::Unexplained,
        None => Verdict::NoGap,
    };
    let mut pool = Pool {
        logs,
        verdict,
        named: Vec::new(),
        sets: sets(&ranking, &weighed),
        alternatives,
        unknown_probability,
        shared: Vec::new(),
        drifting: drifting(&materials, fit),
        fits: log_fits(&materials, &found.null, fit),
        unseen: Vec::new(),
        repeats,
        notes: Vec::new(),
    };
    if verdict != Verdict::Unexplained {
        pool.named.clone_from(&fit.effects.names);
        pool.shared = parameters_of(&materials, fit);
        pool.unseen = unseen::unseen(&materials, fit, model);
    }
    pool.with_read_off(read_off);
    pool.notes = notes(diagnoses, &pool, &remains);
    step();
    pool
}

/// No log serves.
fn refused(logs: Vec<usize>, repeats: Vec<Repeat>) -> Pool {
    Pool {
        logs,
        verdict: Verdict::CannotTell,
        named: Vec::new(),
        sets: Vec::new(),
        alternatives: Vec::new(),
        unknown_probability: 1.0,
        shared: Vec::new(),
        drifting: Vec::new(),
        fits: Vec::new(),
        unseen: Vec::new(),
        repeats,
        notes: Vec::new(),
    }
}

/// The ranking with what each set brings and must bring.
fn sets(ranking: &[SetProbability], weighed: &[Weighed]) -> Vec<PooledSet> {
    let of = |set: &SetProbability| {
        let own = weighed.iter().find(|own| own.effects == set.effects);
        PooledSet {
            effects: set.effects.clone(),
            probability: set.probability,
            nats: own.map_or(0.0, |own| own.nats),
            cost: own.map_or(0.0, |own| own.cost),
            is_fitted: own.is_none_or(|own| own.fit.is_some()),
        }
    };
    ranking.iter().map(of).collect()
}

fn log_fits(materials: &[Material], null: &Fitted, fit: &Fitted) -> Vec<LogFit> {
    let of = |(place, material): (usize, &Material)| LogFit {
        log: material.log,
        samples: material.problem.whitener.count(),
        before: null.squares[place],
        after: fit.squares[place],
    };
    materials.iter().enumerate().map(of).collect()
}

/// A fit with one unit shared, and with it each log's own.
fn both_ways(materials: &[Material], fit: &Fitted, unit: Unit) -> Option<[Fitted; 2]> {
    let other = fit.with_toggled(materials, unit, &[])?;
    Some(if fit.is_own(unit) { [other, fit.clone()] } else { [fit.clone(), other] })
}

/// Values of a set's effects, shared and each log's own.
fn parameters_of(materials: &[Material], fit: &Fitted) -> Vec<Shared> {
    let of = |effect: usize| {
        let unit = Unit::Effect(effect);
        let both = both_ways(materials, fit, unit);
        both.map(|[shared, apart]| values::of_effect(materials, effect, [&shared, &apart], fit.is_own(unit)))
    };
    (0..fit.effects.names.len()).filter_map(of).flatten().collect()
}

/// Nominal parameters that a fit does not share.
fn drifting(materials: &[Material], fit: &Fitted) -> Vec<Shared> {
    let count = materials[0].problem.nuisances.len();
    let own = (0..count).filter(|place| fit.is_own(Unit::Nominal(*place)));
    own.filter_map(|place| {
        let [shared, apart] = both_ways(materials, fit, Unit::Nominal(place))?;
        Some(values::of_nominal(materials, place, [&shared, &apart]))
    })
    .collect()
}

/// What the logs by themselves say otherwise, and what is left.
fn notes(diagnoses: &[Diagnosis], pool: &Pool, remains: &remains::Remains) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some((of, nats)) = remains.goes_with {
        notes.push(format!("what is left in all logs together goes with {of} ({nats:.0} nats beyond chance)"));
    }
    let mut told: Vec<&str> = Vec::new();
    let own = |log: &usize| diagnoses[*log].decision.iter().flat_map(|own| &own.found).map(|own| own.effect);
    for effect in pool.logs.iter().flat_map(own) {
        if !pool.named.contains(&effect) && !told.contains(&effect) {
            told.push(effect);
        }
    }
    if pool.verdict != Verdict::Unexplained {
        for effect in told {
            let set = pool.sets.iter().find(|set| set.effects == [effect] && set.is_fitted);
            let nats = set.map(|set| set.nats);
            let brings = nats
                .filter(|nats| *nats > -100.0)
                .map_or_else(String::new, |nats| format!(": {} nats", told::nats(nats)));
            notes.push(format!("named in one log, not by all logs together: {effect}{brings}"));
        }
    }
    notes
}

impl Pool {
    /// Adds what the samples show by themselves.
    fn with_read_off(&mut self, read_off: Vec<Shared>) {
        for own in read_off {
            for set in &mut self.sets {
                set.effects.push(own.effect);
                set.effects.sort_unstable();
            }
            if matches!(self.verdict, Verdict::NoGap) {
                self.verdict = Verdict::Explained;
                self.unknown_probability = self.unknown_probability.min(0.05);
            } else if self.verdict == Verdict::Unexplained {
                self.verdict = Verdict::PartlyExplained;
            }
            self.named.push(own.effect);
            self.shared.push(own);
        }
    }
}
