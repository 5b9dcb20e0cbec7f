//! Why T5: every single slip of the decimal point, tried against the paper's angles.

use gimbal_servo::{BuildError, Config};

use super::elasticity::{free, step_theta_deg};
use crate::sweep::parameter::PARAMETERS;
use crate::sweep::trial::Case;

/// The factors that a slip may have.
const SLIPS: [f64; 4] = [0.01, 0.1, 10.0, 100.0];
/// Servo and gyro: what the angles of figures 2-1, 2-2 and 7 follow, the stop and the unbalance aside.
const COEFFICIENTS: usize = 15;
/// The published phi of figure 7 [deg], and half its last digit.
pub(super) const PHI_DEG: (f64, f64) = (0.11, 0.005);
/// The stop [deg].
pub(super) const STOP_DEG: f64 = 0.5;

/// What a configuration makes of the published angles.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::struct_field_names, reason = "the unit")]
pub(super) struct Angles {
    /// theta after 1e5 and 3e5 dyne cm, without stops [deg].
    pub(super) steps_deg: [f64; 2],
    /// phi and theta at 20 g on the unbalance, likewise [deg].
    pub(super) phi_deg: f64,
    pub(super) theta_deg: f64,
}

impl Angles {
    pub(super) fn of(config: &Config) -> Result<Self, BuildError> {
        let [phi_deg, theta_deg, _] = free(config, Case::Unbalance)?;
        Ok(Self { steps_deg: [step_theta_deg(config, 1e5)?, step_theta_deg(config, 3e5)?], phi_deg, theta_deg })
    }

    /// Which of the four facts hold: 2-1 not limited, 2-2 limited, 7's phi, 7 not limited.
    pub(super) fn facts(&self) -> [bool; 4] {
        [
            self.steps_deg[0] < STOP_DEG,
            self.steps_deg[1] >= STOP_DEG,
            (self.phi_deg - PHI_DEG.0).abs() <= PHI_DEG.1,
            self.theta_deg < STOP_DEG,
        ]
    }
}

/// A slip in one coefficient as printed.
pub(super) struct Slip {
    pub(super) symbol: &'static str,
    pub(super) factor: f64,
    /// None: the loop is unstable.
    pub(super) angles: Option<Angles>,
}

impl Slip {
    /// Facts that hold.
    pub(super) fn held(&self) -> usize {
        self.angles.map_or(0, |angles| angles.facts().into_iter().filter(|held| *held).count())
    }
}

/// All slips in one coefficient, those that hold most facts first.
pub(super) fn slips() -> Vec<Slip> {
    let printed = Config::as_printed();
    let coefficients = PARAMETERS.iter().take(COEFFICIENTS);
    let each = coefficients.flat_map(|parameter| SLIPS.map(|factor| (parameter, factor)));
    let mut slips: Vec<Slip> = each
        .map(|(parameter, factor)| {
            let angles = Angles::of(&parameter.scaled(&printed, factor)).ok();
            Slip { symbol: parameter.symbol, factor, angles }
        })
        .collect();
    slips.sort_by_key(|slip| std::cmp::Reverse(slip.held()));
    slips
}

#[cfg(test)]
mod tests {
    use super::slips;

    #[test]
    fn paper_only_t5_times_a_hundred_meets_all_angles() {
        let slips = slips();
        let all: Vec<_> = slips.iter().filter(|slip| slip.held() == 4).map(|slip| (slip.symbol, slip.factor)).collect();
        assert_eq!(all, [("T5", 100.0)]);
    }
}
