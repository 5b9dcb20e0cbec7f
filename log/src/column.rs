//! The columns of a log: names, units, and what needs them.

/// A column that has a meaning; all others are extra.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Column {
    /// `time_s` [s].
    Time,
    /// `accel_x_mps2`, specific force along x [m/s2].
    AccelX,
    /// `accel_y_mps2`, specific force along y [m/s2].
    AccelY,
    /// `accel_z_mps2`, specific force along the gimbal axis [m/s2].
    AccelZ,
    /// `vehicle_rate_radps`, vehicle rate about the gimbal axis [rad/s].
    VehicleRate,
    /// `gyro_angle_rad`, pick-off angle theta as measured [rad].
    GyroAngle,
    /// `motor_torque_nm`, motor torque as measured [N m].
    MotorTorque,
    /// `gimbal_angle_rad`, stable member angle by an outside reference [rad].
    GimbalAngle,
    /// `relative_angle_rad`, vehicle against stable member [rad].
    RelativeAngle,
    /// `cross_rate_radps`, vehicle rate about x [rad/s].
    CrossRate,
    /// `temperature_c`, at the platform [deg C].
    Temperature,
}

impl Column {
    /// Number of columns that have a meaning.
    pub const COUNT: usize = 11;

    /// All of them, in the order in which they are written.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Time,
        Self::AccelX,
        Self::AccelY,
        Self::AccelZ,
        Self::VehicleRate,
        Self::GyroAngle,
        Self::MotorTorque,
        Self::GimbalAngle,
        Self::RelativeAngle,
        Self::CrossRate,
        Self::Temperature,
    ];

    /// Name in the header.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Time => "time_s",
            Self::AccelX => "accel_x_mps2",
            Self::AccelY => "accel_y_mps2",
            Self::AccelZ => "accel_z_mps2",
            Self::VehicleRate => "vehicle_rate_radps",
            Self::GyroAngle => "gyro_angle_rad",
            Self::MotorTorque => "motor_torque_nm",
            Self::GimbalAngle => "gimbal_angle_rad",
            Self::RelativeAngle => "relative_angle_rad",
            Self::CrossRate => "cross_rate_radps",
            Self::Temperature => "temperature_c",
        }
    }

    /// Unit, for people.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::AccelX | Self::AccelY | Self::AccelZ => "m/s2",
            Self::VehicleRate | Self::CrossRate => "rad/s",
            Self::GyroAngle | Self::GimbalAngle | Self::RelativeAngle => "rad",
            Self::MotorTorque => "N m",
            Self::Temperature => "deg C",
        }
    }

    /// The name without its unit: `accel_x`.
    #[must_use]
    pub fn stem(self) -> &'static str {
        let name = self.name();
        name.rsplit_once('_').map_or(name, |(stem, _)| stem)
    }

    /// The column of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|column| column.name() == name)
    }

    /// Place in a [`Row`](crate::Row).
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// What a log is read for, which decides the columns that it must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Driving the model: time, the three accelerations, the vehicle rate.
    Run,
    /// Diagnosis and estimation: the same and the gyro angle.
    Diagnosis,
}

impl Needs {
    /// The columns that must be there.
    #[must_use]
    pub const fn columns(self) -> &'static [Column] {
        const ALL: [Column; 6] =
            [Column::Time, Column::AccelX, Column::AccelY, Column::AccelZ, Column::VehicleRate, Column::GyroAngle];
        match self {
            Self::Run => ALL.split_at(5).0,
            Self::Diagnosis => &ALL,
        }
    }

    /// What for, in words.
    #[must_use]
    pub const fn purpose(self) -> &'static str {
        match self {
            Self::Run => "to run the model",
            Self::Diagnosis => "to compare the log with the model",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Column;

    #[test]
    fn contract_places_follow_the_order_of_all() {
        for (index, column) in Column::ALL.into_iter().enumerate() {
            assert_eq!(column.index(), index);
            assert_eq!(Column::named(column.name()), Some(column));
        }
    }
}
