//! Profiles that need no log: the paper's two 20 g cases and a torque step. Rows are held over their period.

use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use gimbal_servo::{Config, Input};

/// Length of every profile [s].
const LENGTH_S: f64 = 10.0;
/// The paper's acceleration lasts this long [s].
const ACCELERATION_S: f64 = 5.0;
/// Its size [m/s2].
const ACCELERATION_MPS2: f64 = 20.0 * STANDARD_GRAVITY_MPS2;
/// The friction case's rate changes sign this often [s].
const REVERSAL_S: f64 = 2.0;
/// Its size [rad/s].
const RATE_RADPS: f64 = 0.1;

/// Rows as a function of time, and the axis that they act on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Profile {
    /// 20 g along y for 5 s on the unbalance: figures 7 and 8.
    Unbalance,
    /// The same on the bearings, with a rate that reverses: figures 9 and 10.
    Friction,
    /// A torque, and when it ends.
    Torque {
        /// Its size [N m].
        torque_nm: f64,
        /// Its end [s].
        off_s: f64,
    },
}

impl Profile {
    /// Name in results and file names.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Unbalance => "unbalance",
            Self::Friction => "friction",
            Self::Torque { .. } => "torque",
        }
    }

    /// What it is, in words.
    pub(crate) fn description(self) -> String {
        match self {
            Self::Unbalance => "20 g for 5 s along y on the unbalance, no friction (paper, figure 7)".to_owned(),
            Self::Friction => {
                "20 g for 5 s along y on the bearings, rate of 0.1 rad/s reversed every 2 s, no unbalance (paper, \
                 figure 9)"
                    .to_owned()
            }
            Self::Torque { torque_nm, off_s } if off_s < LENGTH_S => {
                format!("torque of {torque_nm} N m for {off_s} s, no friction, no unbalance")
            }
            Self::Torque { torque_nm, .. } => format!("torque of {torque_nm} N m, kept on, no friction, no unbalance"),
        }
    }

    /// The axis with what the profile leaves out taken away.
    pub(crate) fn config(self, config: &Config) -> Config {
        match self {
            Self::Unbalance => config.without_friction(),
            Self::Friction => config.without_unbalance(),
            Self::Torque { .. } => config.without_friction().without_unbalance(),
        }
    }

    /// Number of rows, the one at the end included.
    pub(crate) fn len(period_s: f64) -> u32 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "40,001 at the shortest period")]
        let rows = (LENGTH_S / period_s).round() as u32;
        rows + 1
    }

    /// Row `k`.
    pub(crate) fn row(self, k: u32, period_s: f64) -> Input<f64> {
        // Half a period off the edges, so that rounding cannot move them; the last row is as the one before.
        let middle_s = ((f64::from(k) + 0.5) * period_s).min(LENGTH_S - 0.5 * period_s);
        let accelerates = middle_s < ACCELERATION_S;
        let mut row = Input::default();
        match self {
            Self::Unbalance | Self::Friction if accelerates => row.accel_y_mps2 = ACCELERATION_MPS2,
            Self::Torque { torque_nm, off_s } if middle_s < off_s => row.torque_nm = torque_nm,
            _ => {}
        }
        if self == Self::Friction {
            let reversed = (middle_s / REVERSAL_S).floor() % 2.0 > 0.5;
            row.vehicle_rate_radps = if reversed { -RATE_RADPS } else { RATE_RADPS };
        }
        row
    }

    /// `T[,T_OFF_S]` of the command line.
    pub(crate) fn torque(text: &str) -> Result<Self, String> {
        let (torque, off) = text.split_once(',').map_or((text, None), |(torque, off)| (torque, Some(off)));
        let number = |text: &str, unit: &str| {
            let value: f64 = text.trim().parse().map_err(|_| format!("`{text}` is not a number; write {unit}"))?;
            if value.is_finite() { Ok(value) } else { Err(format!("`{text}` is not finite; write {unit}")) }
        };
        let torque_nm = number(torque, "a torque in N m")?;
        let off_s = off.map_or(Ok(f64::INFINITY), |off| number(off, "its end in s"))?;
        if off_s < 0.0 {
            return Err(format!("the torque ends at {off_s} s; write a time from 0 to 10 s"));
        }
        Ok(Self::Torque { torque_nm, off_s })
    }
}

#[cfg(test)]
mod tests {
    use super::Profile;

    #[test]
    #[allow(clippy::float_cmp, reason = "values are set, not computed")]
    fn paper_acceleration_lasts_five_seconds_and_the_rate_turns_every_two() {
        for period_s in [0.25e-3, 1e-3, 4e-3] {
            let rows: Vec<_> = (0..Profile::len(period_s)).map(|k| Profile::Friction.row(k, period_s)).collect();
            let pushed = rows.iter().filter(|row| row.accel_y_mps2 > 0.0).count();
            assert!((f64::from(u32::try_from(pushed).expect("few")) * period_s - 5.0).abs() < 1e-9);
            let turns = rows.windows(2).filter(|pair| pair[0].vehicle_rate_radps != pair[1].vehicle_rate_radps).count();
            assert_eq!(turns, 4);
            assert_eq!(rows[0].vehicle_rate_radps, 0.1);
        }
    }

    #[test]
    fn contract_a_torque_step_is_read() {
        assert_eq!(Profile::torque("0.03"), Ok(Profile::Torque { torque_nm: 0.03, off_s: f64::INFINITY }));
        assert_eq!(Profile::torque("-0.03,2.5"), Ok(Profile::Torque { torque_nm: -0.03, off_s: 2.5 }));
        assert!(Profile::torque("0.03,-1").is_err() && Profile::torque("big").is_err());
    }
}
