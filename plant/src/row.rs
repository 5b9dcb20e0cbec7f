//! One row of inputs, and what acts between two rows.

use gimbal_servo::Interpolation;

/// Inputs at one instant; point samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Row {
    /// Specific force along x [m/s2].
    pub accel_x_mps2: f64,
    /// Specific force along y [m/s2].
    pub accel_y_mps2: f64,
    /// Specific force along the gimbal axis z [m/s2].
    pub accel_z_mps2: f64,
    /// Vehicle rate about the gimbal axis [rad/s].
    pub vehicle_rate_radps: f64,
    /// Vehicle rate about x [rad/s]; acts through `cross_axis_coupling` only.
    pub cross_rate_radps: f64,
    /// `w_x`, the stable member's own inertial rate about the gyro's spin axis [rad/s]; acts only with
    /// `gyro.cross_coupling`.
    pub spin_rate_radps: f64,
    /// External disturbance torque on the gimbal [N m].
    pub torque_nm: f64,
}

/// What the inputs do between row k-1 and row k.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Between {
    /// They run along a straight line.
    Line,
    /// Row k-1 is held.
    Held,
    /// The mean of both rows acts, which is what the real-time model assumes.
    Mean,
}

impl From<Interpolation> for Between {
    /// Point samples are interpolated; held rows stay held.
    fn from(interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::Mean => Self::Line,
            Interpolation::Held => Self::Held,
        }
    }
}

impl Row {
    /// The row at `share` of the way to `next`.
    #[must_use]
    pub fn toward(&self, next: &Self, share: f64) -> Self {
        let line = |from: f64, to: f64| from + share * (to - from);
        Self {
            accel_x_mps2: line(self.accel_x_mps2, next.accel_x_mps2),
            accel_y_mps2: line(self.accel_y_mps2, next.accel_y_mps2),
            accel_z_mps2: line(self.accel_z_mps2, next.accel_z_mps2),
            vehicle_rate_radps: line(self.vehicle_rate_radps, next.vehicle_rate_radps),
            cross_rate_radps: line(self.cross_rate_radps, next.cross_rate_radps),
            spin_rate_radps: line(self.spin_rate_radps, next.spin_rate_radps),
            torque_nm: line(self.torque_nm, next.torque_nm),
        }
    }

    /// `A_r`, specific force normal to the gimbal axis [m/s2].
    #[must_use]
    pub fn radial_accel_mps2(&self) -> f64 {
        (self.accel_x_mps2 * self.accel_x_mps2 + self.accel_y_mps2 * self.accel_y_mps2).sqrt()
    }
}

/// The inputs over one period, as a function of the time since row k-1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interval {
    from: Row,
    to: Row,
    period_s: f64,
}

impl Interval {
    pub(crate) fn new(previous: &Row, row: &Row, period_s: f64, between: Between) -> Self {
        let (from, to) = match between {
            Between::Line => (*previous, *row),
            Between::Held => (*previous, *previous),
            Between::Mean => {
                let mean = previous.toward(row, 0.5);
                (mean, mean)
            }
        };
        Self { from, to, period_s }
    }

    pub(crate) fn at(&self, tau_s: f64) -> Row {
        self.from.toward(&self.to, tau_s / self.period_s)
    }

    pub(crate) fn period_s(&self) -> f64 {
        self.period_s
    }

    /// Shares of the period at which the bearing load bends: `a_z` changes sign, or `A_r` passes its least.
    pub(crate) fn bends(&self) -> [Option<f64>; 2] {
        let (from, to) = (&self.from, &self.to);
        let inside = |share: f64| (share > 0.0 && share < 1.0).then_some(share);
        let axial = inside(from.accel_z_mps2 / (from.accel_z_mps2 - to.accel_z_mps2));
        let run = [to.accel_x_mps2 - from.accel_x_mps2, to.accel_y_mps2 - from.accel_y_mps2];
        let run2 = run[0] * run[0] + run[1] * run[1];
        let nearest = inside(-(from.accel_x_mps2 * run[0] + from.accel_y_mps2 * run[1]) / run2);
        [axial, nearest]
    }
}
