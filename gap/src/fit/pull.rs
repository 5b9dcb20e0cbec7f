//! The priors of the nominal parameters at their shifts: slopes, curvatures, cost.

use super::Problem;

/// The priors at given shifts; a released parameter has a plain one.
pub(crate) struct Pull {
    /// Half the slope of the cost.
    pub(crate) slope: Vec<f64>,
    /// Half its curvature.
    pub(crate) curvature: Vec<f64>,
    /// Cost of all.
    pub(crate) cost: f64,
    /// What walls add to the logarithm of the precision [nats].
    pub(crate) walls: f64,
}

impl Pull {
    pub(crate) fn new(problem: &Problem, precision: &[f64], shifts: &[f64]) -> Self {
        Self::ahead(problem, precision, shifts, shifts)
    }

    /// The same with the walls that stand at other shifts, those that a step ends at.
    pub(crate) fn ahead(problem: &Problem, precision: &[f64], shifts: &[f64], ahead: &[f64]) -> Self {
        let mut pull = Self { slope: Vec::new(), curvature: Vec::new(), cost: 0.0, walls: 0.0 };
        for (place, (nuisance, shift)) in problem.nuisances.iter().zip(shifts).enumerate() {
            let own = precision[problem.columns.begin + place];
            let flat = 1.0 / (nuisance.sigma * nuisance.sigma);
            let released = own < 0.98 * flat;
            let (slope, curvature, cost) =
                if released { (own * shift, own, own * shift * shift) } else { nuisance.prior(*shift, ahead[place]) };
            pull.slope.push(slope);
            pull.curvature.push(curvature);
            pull.cost += cost;
            if !released {
                pull.walls += 0.5 * (curvature / flat).ln();
            }
        }
        pull
    }
}
