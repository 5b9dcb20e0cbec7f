//! What would have been seen: the smallest size of each effect that is not there.

use gimbal_model_file::Tolerance;
use gimbal_plant::Effect;
use nalgebra::DVector;

use crate::fit::{Problem, solve};

/// Standard errors at which an effect is named.
const SEEN: f64 = 7.0;

/// The smallest size of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Detectable {
    /// Name.
    pub effect: &'static str,
    /// Name of its first parameter.
    pub parameter: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Smallest size that would have been named; none when this log cannot show the effect.
    pub size: Option<f64>,
}

/// For every effect of the library.
#[must_use]
pub fn detectable(problem: &Problem, tolerance: &Tolerance) -> Vec<Detectable> {
    let nothing = DVector::zeros(problem.gram.nrows());
    Effect::all()
        .filter(|effect| !problem.not_looked_for.contains(&effect.name()))
        .map(|effect| {
            let parameter = effect.parameters()[0];
            let sizes =
                problem.candidates.iter().enumerate().filter(|(_, candidate)| candidate.effect == effect.name());
            let size = sizes.filter_map(|(index, candidate)| {
                let (chosen, precision) = problem.chosen(&[index]);
                let solution = solve(&problem.gram, &nothing, &chosen, &precision)?;
                if let Some(release) = candidate.releases.first() {
                    let place = problem.columns.begin + problem.nuisances.iter().position(|n| n.name == *release)?;
                    let sigma = solution.covariance[(place, place)].sqrt();
                    let scale = if effect.name() == "mass_unbalance" {
                        problem.nuisances.iter().find(|n| n.name == *release)?.sigma / tolerance.of(effect.name())
                    } else {
                        1.0
                    };
                    return Some((SEEN * sigma).max(1.15 * tolerance.of(effect.name()) * scale));
                }
                let place = chosen.len() - candidate.probes.len();
                let sigma = solution.covariance[(place, place)].sqrt();
                let secant = (candidate.probes[0].1 - 1.0).abs() < 1e-12 && candidate.probes[0].0[0] < 0.5;
                let informative = sigma < 0.5 * candidate.prior[0].1;
                informative.then(|| if secant { SEEN * sigma * candidate.probes[0].0[0] } else { SEEN * sigma })
            });
            let size = size.fold(None, |least: Option<f64>, size| Some(least.map_or(size, |least| least.min(size))));
            Detectable { effect: effect.name(), parameter: parameter.name, unit: parameter.unit, size }
        })
        .collect()
}
