//! What moves the platform: rows of true inputs, linear in between.

/// Inputs at one instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Row {
    /// Specific force along x, y, z [m/s2].
    pub accel_mps2: [f64; 3],
    /// Vehicle rate about the gimbal axis [rad/s].
    pub rate_radps: f64,
    /// Vehicle rate about x [rad/s].
    pub cross_rate_radps: f64,
    /// External torque on the gimbal [N m].
    pub external_nm: f64,
    /// Temperature at the platform [deg C].
    pub temperature_c: f64,
}

impl Row {
    /// The row a share `part` of the way to `other`.
    #[must_use]
    pub fn towards(&self, other: &Self, part: f64) -> Self {
        let mix = |from: f64, to: f64| from + (to - from) * part;
        Self {
            accel_mps2: core::array::from_fn(|axis| mix(self.accel_mps2[axis], other.accel_mps2[axis])),
            rate_radps: mix(self.rate_radps, other.rate_radps),
            cross_rate_radps: mix(self.cross_rate_radps, other.cross_rate_radps),
            external_nm: mix(self.external_nm, other.external_nm),
            temperature_c: mix(self.temperature_c, other.temperature_c),
        }
    }
}

/// Rows at a constant period.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Time between rows [s].
    pub period_s: f64,
    /// The rows; at least one.
    pub rows: Vec<Row>,
}

impl Track {
    /// A row and the next one; the last goes on for ever.
    #[must_use]
    pub fn around(&self, row: usize) -> (&Row, &Row) {
        let last = self.rows.len() - 1;
        (&self.rows[row.min(last)], &self.rows[(row + 1).min(last)])
    }

    /// Inputs at `time_s` after the first row; the first and last rows go on for ever.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the rows
    pub fn at(&self, time_s: f64) -> Row {
        let place = (time_s / self.period_s).clamp(0.0, (self.rows.len() - 1) as f64);
        let index = (place as usize).min(self.rows.len().saturating_sub(2));
        match self.rows.get(index + 1) {
            Some(next) => self.rows[index].towards(next, place - index as f64),
            None => self.rows[index],
        }
    }
}
