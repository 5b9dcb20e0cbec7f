//! A set of effects as all logs try it.

use super::material::Material;
use super::parameters::{Parameter, Unit};
use crate::fit::Set;
use crate::library::Candidate;

/// Effects, where their values begin, and what each log's candidates of them are.
#[derive(Debug, Clone)]
pub(super) struct Effects {
    /// In alphabetical order.
    pub(super) names: Vec<&'static str>,
    /// Values from which they are fitted, and about which their shapes are looked for.
    pub(super) start: Vec<Vec<f64>>,
    /// Shifts of the nominal parameters to begin with, where they are known.
    pub(super) shifts: Option<Vec<f64>>,
    /// The set in each log.
    pub(super) sets: Vec<Set>,
    /// What the search over each one's settings costs [nats].
    pub(super) search: Vec<f64>,
}

impl Effects {
    /// The nominal parameters alone.
    pub(super) fn none(logs: usize) -> Self {
        let sets = vec![Set::default(); logs];
        Self { names: Vec::new(), start: Vec::new(), shifts: None, sets, search: Vec::new() }
    }

    /// Candidates with the values to begin with.
    pub(super) fn new(
        materials: &mut [Material],
        candidates: &[Candidate],
        values: &[Vec<f64>],
        shifts: Option<Vec<f64>>,
    ) -> Self {
        let mut order: Vec<usize> = (0..candidates.len()).collect();
        order.sort_by_key(|&place| candidates[place].effect);
        let index =
            |material: &mut Material| order.iter().map(|&p| material.problem.candidate_of(&candidates[p])).collect();
        Self {
            names: order.iter().map(|&place| candidates[place].effect).collect(),
            start: order.iter().map(|&place| values[place].clone()).collect(),
            shifts,
            sets: materials.iter_mut().map(|material| Set(index(material))).collect(),
            search: order.iter().map(|&place| (candidates[place].siblings as f64).ln()).collect(),
        }
    }

    /// What the search over settings costs: once for what is shared, for each log what is its own [nats].
    pub(super) fn searched(&self, own: &[bool], parameters: &[Parameter], logs: usize) -> f64 {
        let apart = |effect: usize| {
            let of = |parameter: &Parameter| parameter.unit == Unit::Effect(effect);
            parameters.iter().zip(own).any(|(parameter, own)| *own && of(parameter))
        };
        let times = |effect: usize| if apart(effect) { logs as f64 } else { 1.0 };
        self.search.iter().enumerate().map(|(effect, nats)| times(effect) * nats).sum()
    }
}
