//! Every field of a model file: table, key, meaning, unit. A test holds it against the structs.

/// Table, key, symbol and meaning with the unit in brackets.
pub(crate) const FIELDS: [(&str, &str, &str); 43] = [
    ("servo", "gimbal_inertia_kg_m2", "Jg, inertia of the stable member about the gimbal axis [kg m2]"),
    ("servo", "gain_nm_per_rad_s", "K, gain of F(s), which has an integrator [N m/(rad s)]"),
    ("servo", "lead_time_constants_s", "T1 to T5, zeros of F(s) [s]"),
    ("servo", "lag_time_constants_s", "T6 to T9, poles of F(s) beside the integrator [s]"),
    ("servo", "motor_lag_s", "T, first-order lag of the motor [s]"),
    ("gyro", "float_inertia_kg_m2", "Jo, inertia of the float about the output axis [kg m2]"),
    ("gyro", "damping_nm_s_per_rad", "Bo, damping of the float about the output axis [N m s/rad]"),
    ("gyro", "angular_momentum_nm_s", "H, angular momentum of the wheel [N m s]"),
    ("gyro", "stop_angle_rad", "largest output angle to either side [rad]"),
    ("gyro", "cross_coupling", "whether theta couples the rate about the spin axis into the gyro"),
    ("bearing", "count", "bearings on the gimbal axis; 0 takes friction out of the model"),
    ("bearing", "preload_n", "axial preload of each bearing [N]"),
    ("bearing", "gimbal_weight_n", "W, weight of the gimbal at 1 g [N]"),
    ("bearing", "pitch_diameter_m", "dm, pitch diameter [m]"),
    ("bearing", "load_torque_nm_per_n", "c, load torque per N^(1 + load_exponent) [N m/N^(1 + load_exponent)]"),
    ("bearing", "load_exponent", "exponent of the static equivalent load F_s"),
    ("bearing", "static_axial_factor", "share of F_a in F_s"),
    ("bearing", "static_radial_factor", "share of F_r in F_s"),
    ("bearing", "torque_axial_factor", "factor of F_a in (6.1), 0.9 cot(contact angle)"),
    ("bearing", "torque_radial_factor", "factor of F_r, subtracted in (6.1)"),
    ("bearing", "lubrication_factor", "f0, lubrication factor"),
    ("bearing", "viscosity_m2ps", "nu, kinematic viscosity of the lubricant [m2/s]"),
    ("bearing", "viscous_law", "\"printed\": 35 % jump at the Palmgren break; \"metric\": continuous"),
    ("bearing", "slip_rate_radps", "w_s, half width of the clamp that stands in for stiction [rad/s]"),
    ("unbalance", "x_kg_m", "u_x, torque per specific force along y [N m/(m/s2) = kg m]"),
    ("unbalance", "y_kg_m", "u_y, torque per specific force along -x [N m/(m/s2) = kg m]"),
    ("range", "radial_accel_mps2", "largest specific force along x and along y [m/s2]"),
    ("range", "axial_accel_mps2", "largest specific force along z [m/s2]"),
    ("range", "rate_radps", "largest rates [rad/s]"),
    ("range", "torque_nm", "largest external disturbance torque [N m]"),
    ("tolerance", "default_relative", "relative, for every parameter not named below: T1 to T9, Jo and w_s among them"),
    ("tolerance", "friction_level", "relative, load friction"),
    ("tolerance", "viscous_friction", "relative"),
    ("tolerance", "mass_unbalance", "relative to the nominal size of the vector"),
    ("tolerance", "loop_gain", "relative, K"),
    ("tolerance", "motor_lag", "relative, T"),
    ("tolerance", "gyro_damping", "relative, Bo"),
    ("tolerance", "angular_momentum", "relative, H"),
    ("tolerance", "stop_angle", "relative"),
    ("tolerance", "gimbal_inertia", "relative, Jg"),
    ("tolerance", "pickoff_scale", "relative, of the logged gyro angle"),
    ("tolerance", "torque_scale", "relative, of the logged motor torque"),
    ("tolerance", "vehicle_rate_bias_radps", "bias of the logged vehicle rate [rad/s]"),
];

/// The known name that is nearest.
pub(crate) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let nearness = |candidate: &str| strsim::jaro_winkler(&name.to_ascii_lowercase(), candidate);
    known.max_by(|a, b| nearness(a).total_cmp(&nearness(b))).unwrap_or_default().to_owned()
}

/// The table that a key belongs to, if it is one's.
pub(crate) fn home(key: &str) -> Option<&'static str> {
    FIELDS.iter().find(|(_, name, _)| *name == key).map(|(table, _, _)| *table)
}
