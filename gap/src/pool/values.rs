//! Values of effects over the logs: the one that all share, and each log's own.

use super::climb::Fitted;
use super::joint::Joint;
use super::material::Material;
use super::parameters::Unit;
use crate::fit::Hypothesis;

/// Share of its prior's standard deviation from which on a log knows nothing of a value.
const UNKNOWN: f64 = 0.5;

/// A parameter over the logs.
#[derive(Debug, Clone, PartialEq)]
pub struct Shared {
    /// Effect, or nominal parameter.
    pub effect: &'static str,
    /// Parameter.
    pub parameter: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Log, value and standard error of what is each log's own, where a log shows it.
    pub values: Vec<(usize, f64, f64)>,
    /// Value that all logs share, and its standard error.
    pub mean: [f64; 2],
    /// Sum of squares over the errors.
    pub chi2: f64,
    /// How probable such a scatter is by chance.
    pub by_chance: f64,
    /// Evidence of one value for all logs over a value for each [nats]; none where that was not fitted.
    pub shared_nats: Option<f64>,
    /// Whether it drifts from run to run.
    pub drifts: bool,
}

/// Where a value of an effect stands in a log.
struct Place {
    /// Among the parameters.
    parameter: usize,
    /// A released one has its value by a change of the nominal parameter.
    nominal: Option<usize>,
    log: bool,
}

/// Places of an effect's values, none of a value that is not fitted.
fn places(hypothesis: &Hypothesis, effect: usize) -> Vec<Option<Place>> {
    let problem = hypothesis.problem;
    let candidate = &problem.candidates[hypothesis.set.0[effect]];
    if !candidate.releases.is_empty() {
        let place =
            |name: &&str| problem.nuisance(name).map(|at| Place { parameter: at, nominal: Some(at), log: false });
        return candidate.releases.iter().map(place).collect();
    }
    let count = gimbal_plant::Effect::from_name(candidate.effect).map_or(0, |entry| entry.parameters().len());
    let place = |value: usize| {
        let free = hypothesis.free.iter().position(|free| free.effect == effect && free.value == value)?;
        let parameter = problem.nuisances.len() + free;
        Some(Place { parameter, nominal: None, log: hypothesis.free[free].log })
    };
    (0..count).map(place).collect()
}

impl Fitted {
    /// Values and standard errors of an effect: once where it is shared, of each log where it is its own.
    pub(super) fn known(&self, materials: &[Material], effect: usize) -> Vec<(Vec<f64>, Vec<f64>)> {
        let logs = if self.is_own(Unit::Effect(effect)) { materials.len() } else { 1 };
        let hypotheses = super::climb::hypotheses(materials, &self.effects);
        let value = |log: usize, place: &Option<Place>| {
            place.as_ref().map_or((0.0, 0.0), |place| self.value(materials, log, place))
        };
        let of = |log: usize| places(&hypotheses[log], effect).iter().map(|place| value(log, place)).unzip();
        (0..logs).map(of).collect()
    }

    /// A value of a log and its standard error.
    fn value(&self, materials: &[Material], log: usize, place: &Place) -> (f64, f64) {
        let sigma = self.joint.variance(log, place.parameter).sqrt();
        place.shown(&materials[log], self.coordinate(log, place.parameter), sigma)
    }

    /// Whether a log knows more of a parameter than was known before.
    fn shows(&self, log: usize, parameter: usize) -> bool {
        self.joint.variance(log, parameter).sqrt() < UNKNOWN * self.parameters[parameter].prior.flat().powf(-0.5)
    }

    /// Where a log stands.
    fn coordinate(&self, log: usize, parameter: usize) -> f64 {
        let local = &self.locals[log];
        local.at[local.begin.len() + parameter]
    }
}

impl Place {
    /// A coordinate and its standard error as a value of the effect.
    fn shown(&self, material: &Material, at: f64, sigma: f64) -> (f64, f64) {
        match self.nominal {
            Some(nominal) => change(material, nominal, at, sigma),
            None if self.log => (at.exp(), at.exp() * sigma),
            None => (at, sigma),
        }
    }
}

/// A shift of a nominal parameter as a change.
fn change(material: &Material, nominal: usize, shift: f64, sigma: f64) -> (f64, f64) {
    let (nuisance, base) = (&material.problem.nuisances[nominal], &material.problem.base);
    let value = nuisance.change(base, shift);
    (value, nuisance.change(base, shift + sigma) - value)
}

/// Values of an effect, from its fit as one value and as each log's own.
pub(super) fn of_effect(
    materials: &[Material],
    effect: usize,
    [shared, apart]: [&Fitted; 2],
    drifts: bool,
) -> Vec<Shared> {
    let name = shared.effects.names[effect];
    let Some(entry) = gimbal_plant::Effect::from_name(name) else { return Vec::new() };
    let all = super::climb::hypotheses(materials, &shared.effects);
    let nats = shared.evidence - apart.evidence;
    let places = places(&all[0], effect);
    let parameters = entry.parameters().iter().zip(&places);
    let of = |(parameter, place): (&gimbal_plant::Parameter, &Option<Place>)| {
        let place = place.as_ref()?;
        let (chi2, by_chance) = scatter(apart, place.parameter);
        let mean: [f64; 2] = shared.value(materials, 0, place).into();
        let shows = |log: &usize| apart.shows(*log, place.parameter);
        let value = |log: usize| {
            let (value, error) = apart.value(materials, log, place);
            (materials[log].log, value, error)
        };
        Some(Shared {
            effect: name,
            parameter: parameter.name,
            unit: parameter.unit,
            values: (0..materials.len()).filter(shows).map(value).collect(),
            mean,
            chi2,
            by_chance,
            shared_nats: Some(nats),
            drifts,
        })
    };
    parameters.filter_map(of).collect()
}

/// A nominal parameter that is each log's own.
pub(super) fn of_nominal(materials: &[Material], nominal: usize, [shared, apart]: [&Fitted; 2]) -> Shared {
    let nuisance = &materials[0].problem.nuisances[nominal];
    let place = Place { parameter: nominal, nominal: Some(nominal), log: false };
    let (chi2, by_chance) = scatter(apart, nominal);
    let own = |log: usize| {
        let (value, error) = apart.value(materials, log, &place);
        (materials[log].log, value, error)
    };
    Shared {
        effect: nuisance.name,
        parameter: "change",
        unit: match nuisance.name {
            _ if !nuisance.absolute => "1",
            name if name.starts_with("unbalance") => "kg m",
            _ => "rad",
        },
        values: (0..materials.len()).filter(|log| apart.shows(*log, nominal)).map(own).collect(),
        mean: shared.value(materials, 0, &place).into(),
        chi2,
        by_chance,
        shared_nats: Some(shared.evidence - apart.evidence),
        drifts: true,
    }
}

/// Chi-square of what is each log's own about the weighted mean, and how probable that is by chance.
///
/// ```text
/// chi2 = (v - m)' C^-1 (v - m)        m = 1' C^-1 v / 1' C^-1 1        C: covariance of the values of all logs
/// ```
fn scatter(apart: &Fitted, parameter: usize) -> (f64, f64) {
    let logs: Vec<usize> = (0..apart.locals.len()).filter(|log| apart.shows(*log, parameter)).collect();
    let n = logs.len();
    if n < 2 {
        return (0.0, 1.0);
    }
    let joint: &Joint = &apart.joint;
    let covariance = nalgebra::DMatrix::from_fn(n, n, |i, j| joint.covariance_of(parameter, logs[i], logs[j]));
    let Some(inverse) = covariance.cholesky().map(|factor| factor.inverse()) else { return (0.0, 1.0) };
    let values = nalgebra::DVector::from_fn(n, |i, _| apart.coordinate(logs[i], parameter));
    let ones = nalgebra::DVector::from_element(n, 1.0);
    let mean = ones.dot(&(&inverse * &values)) / ones.dot(&(&inverse * &ones));
    let off = values.add_scalar(-mean);
    let chi2 = off.dot(&(&inverse * &off));
    (chi2, chance(chi2, n - 1))
}

/// Probability of a larger chi-square by chance: Wilson and Hilferty's cube root.
pub(super) fn chance(chi2: f64, freedom: usize) -> f64 {
    if freedom == 0 {
        return 1.0;
    }
    let n = freedom as f64;
    let spread = 2.0 / (9.0 * n);
    let z = ((chi2 / n).cbrt() - (1.0 - spread)) / spread.sqrt();
    0.5 * libm::erfc(z / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::chance;

    #[test]
    fn closed_form_tails_of_chi_square_are_those_of_tables() {
        // 95 % and 99 % points of 1, 4 and 10 degrees of freedom; the cube root is good to a tenth of the tail.
        for (chi2, freedom, tail) in [(3.841, 1, 0.05), (9.488, 4, 0.05), (18.307, 10, 0.05), (13.277, 4, 0.01)] {
            let found = chance(chi2, freedom);
            assert!((found / tail - 1.0).abs() < 0.12, "{chi2} of {freedom}: {found}");
        }
        assert!((chance(5.0, 0) - 1.0).abs() < 1e-12);
    }
}
