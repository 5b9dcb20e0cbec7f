//! `presliding`: friction that builds up over a displacement at each reversal, after Dahl.
//!
//! ```text
//! d zeta / d rel = (1 - zeta sgn w_rel) / x0          T_f = (T_load + T_visc) zeta, in place of the clamp
//! ```
//!
//! Between two reversals the rate keeps its sign s and the equation has the solution
//! `zeta = s + (zeta_r - s) exp(-|rel - rel_r| / x0)` from the values at the last reversal, which is what is
//! computed: integrated as it stands, the equation is stiff at high rates.
//!
//! Block `friction`; a displacement of zero leaves the clamp in place. Changes `gyro_angle_rad`,
//! `motor_torque_nm` and the angles of the gimbal.
//!
//! Source: P. R. Dahl, *A solid friction model*, Aerospace Corporation TOR-0158(3107-18)-1, 1968.

use super::Altered;

/// The displacement over which friction builds up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Presliding {
    displacement_rad: f64,
}

/// zeta and rel at the last reversal.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Reversal {
    pub(crate) ratio: f64,
    pub(crate) relative_rad: f64,
}

impl Presliding {
    /// zeta, the share of the full friction, on a stretch of one sign.
    pub(crate) fn ratio(self, reversal: &Reversal, sign: f64, relative_rad: f64) -> f64 {
        let travel = sign * (relative_rad - reversal.relative_rad) / self.displacement_rad;
        sign + (reversal.ratio - sign) * (-travel).exp()
    }
}

pub(super) fn apply(values: &[f64], altered: &mut Altered) {
    altered.laws.presliding = Some(Presliding { displacement_rad: values[0] });
}
