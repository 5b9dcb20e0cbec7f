//! The table of effects, and what holds for all of them.

mod rig;

use gimbal_plant::{Block, Bound, Effect, EffectError, Plant, Sample};

const NAMES: [(Block, &str); 6] = [
    (
        Block::Friction,
        "friction_level viscous_friction stribeck presliding load_dependence direction_asymmetry quadratic_drag \
         friction_drift",
    ),
    (
        Block::Disturbance,
        "mass_unbalance anisoelasticity cable_spring cable_hysteresis torque_ripple constant_torque \
         cross_axis_coupling",
    ),
    (Block::Servo, "loop_gain loop_delay motor_lag torque_saturation dead_zone pickoff_quantisation"),
    (Block::Gyro, "gyro_damping angular_momentum stop_angle float_torque g_sensitive_float_torque"),
    (Block::Structure, "gimbal_inertia flexible_mode"),
    (Block::Measurement, "pickoff_scale pickoff_bias torque_scale torque_bias time_skew"),
];

/// Units and the endings of names that go with them.
const ENDINGS: [(&str, &str); 16] = [
    ("1", ""),
    ("s", "_s"),
    ("rad", "_rad"),
    ("rad/s", "_radps"),
    ("Hz", "_hz"),
    ("N m", "_nm"),
    ("N m/rad", "_nm_per_rad"),
    ("N m s/rad", "_nm_s_per_rad"),
    ("N m s2/rad2", "_nm_s2_per_rad2"),
    ("N m s4/m2", "_nm_s4_per_m2"),
    ("kg m", "_kg_m"),
    ("kg m2", "_kg_m2"),
    ("N", "_n"),
    ("m", "_m"),
    ("kg", "_kg"),
    ("m/s2", "_mps2"),
];

#[test]
fn closed_form_every_effect_of_the_contract_is_there_and_no_other() {
    let expected: Vec<(Block, &str)> =
        NAMES.iter().flat_map(|(block, names)| names.split(' ').map(move |name| (*block, name))).collect();
    let given: Vec<(Block, &str)> = Effect::all().map(|effect| (effect.block(), effect.name())).collect();
    assert_eq!(given, expected);
    for (_, name) in expected {
        assert_eq!(Effect::from_name(name).map(Effect::name), Some(name));
    }
    assert_eq!(Effect::from_name("Stribeck"), None);
}

#[test]
fn closed_form_every_parameter_has_its_unit_in_its_name_and_an_ordered_range() {
    for effect in Effect::all() {
        assert!((1..=effect.parameters().len()).contains(&effect.sizes()), "{effect:?}");
        for parameter in effect.parameters() {
            let (_, ending) = ENDINGS.iter().find(|(unit, _)| *unit == parameter.unit).unwrap();
            assert!(parameter.name.ends_with(ending), "{effect:?} {parameter:?}");
            assert!(parameter.low < parameter.typical && parameter.typical < parameter.high, "{parameter:?}");
            assert!(parameter.bound == Bound::Any || parameter.low > 0.0, "{parameter:?}");
        }
    }
}

#[test]
fn closed_form_every_effect_of_size_zero_is_the_nominal_plant() {
    let rows: Vec<_> = rig::flight().into_iter().take(1000).collect();
    let nominal: Vec<Sample> = rig::nominal().run(rows.iter().copied()).collect();
    for effect in Effect::all() {
        let mut values = effect.typical();
        values[..effect.sizes()].fill(0.0);
        let plant = rig::nominal().with_effect(effect, &values).unwrap();
        assert_eq!(plant.run(rows.iter().copied()).collect::<Vec<_>>(), nominal, "{effect:?}");
    }
}

/// Columns of a log in which two runs differ.
fn changed(a: &[Sample], b: &[Sample]) -> Vec<&'static str> {
    type Column = (&'static str, fn(&Sample) -> f64);
    const COLUMNS: [Column; 9] = [
        ("accel_x_mps2", |sample| sample.logged.inputs.accel_x_mps2),
        ("accel_y_mps2", |sample| sample.logged.inputs.accel_y_mps2),
        ("accel_z_mps2", |sample| sample.logged.inputs.accel_z_mps2),
        ("vehicle_rate_radps", |sample| sample.logged.inputs.vehicle_rate_radps),
        ("cross_rate_radps", |sample| sample.logged.inputs.cross_rate_radps),
        ("gyro_angle_rad", |sample| sample.logged.gyro_angle_rad),
        ("motor_torque_nm", |sample| sample.logged.motor_torque_nm),
        ("gimbal_angle_rad", |sample| sample.gimbal_angle_rad),
        ("relative_angle_rad", |sample| sample.relative_angle_rad),
    ];
    let differs = |(_, of): &&Column| a.iter().zip(b).any(|(a, b)| (of(a) - of(b)).abs() > 1e-9);
    COLUMNS.iter().filter(differs).map(|(name, _)| *name).collect()
}

fn runs_with(effect: Effect, values: &[f64]) -> Vec<Sample> {
    rig::nominal().with_effect(effect, values).unwrap().run(rig::flight()).collect()
}

#[test]
fn closed_form_every_effect_changes_the_columns_that_it_names() {
    let nominal: Vec<Sample> = rig::nominal().run(rig::flight()).collect();
    for effect in Effect::all() {
        let mut values = effect.typical();
        let mut columns = changed(&runs_with(effect, &values), &nominal);
        if effect.name() == "time_skew" {
            // late inputs change the inputs, early ones theta and torque
            values[0] = -values[0];
            columns.extend(changed(&runs_with(effect, &values), &nominal));
        }
        let mut named = effect.columns().to_vec();
        named.sort_unstable();
        columns.sort_unstable();
        assert_eq!(columns, named, "{effect:?}");
    }
}

#[test]
fn closed_form_the_loop_is_stable_over_every_range() {
    let mut unstable = Vec::new();
    for effect in Effect::all() {
        for (index, parameter) in effect.parameters().iter().enumerate() {
            for end in [parameter.low, parameter.high] {
                let mut values = effect.typical();
                values[index] = end;
                let samples = runs_with(effect, &values);
                // On a stop the gimbal runs away from its torque, for as long as that lasts; afterwards it is quiet.
                let angle = peak(&samples, |sample| sample.gimbal_angle_rad);
                let rate = peak(&samples[1800..], |sample| sample.gimbal_rate_radps);
                if angle > 0.3 || rate > 0.3 {
                    unstable.push((effect, values, angle, rate));
                }
            }
        }
    }
    assert!(unstable.is_empty(), "{unstable:?}");
}

#[test]
fn closed_form_every_effect_is_integrated_to_a_billionth_of_the_peak() {
    let mut coarse = Vec::new();
    for effect in Effect::all() {
        let plant = rig::nominal().with_effect(effect, &effect.typical()).unwrap();
        let nominal: Vec<Sample> = plant.run(rig::flight()).collect();
        let fine: Vec<Sample> = plant.clone().with_tolerance(1e-12).run(rig::flight()).collect();
        let worst =
            nominal.iter().zip(&fine).map(|(a, b)| (a.gimbal_angle_rad - b.gimbal_angle_rad).abs()).fold(0.0, f64::max);
        let change = worst / peak(&fine, |sample| sample.gimbal_angle_rad);
        if change > 1e-9 {
            coarse.push((effect, change));
        }
    }
    assert!(coarse.is_empty(), "{coarse:?}");
}

fn peak(samples: &[Sample], of: impl Fn(&Sample) -> f64) -> f64 {
    samples.iter().fold(0.0, |peak, sample| f64::max(peak, of(sample).abs()))
}

#[test]
fn closed_form_effects_add_up_in_any_order() {
    let add = |plant: Plant, effect: Effect| plant.with_effect(effect, &effect.typical()).unwrap();
    let forward = Effect::all().fold(rig::nominal(), add);
    let mut effects: Vec<Effect> = Effect::all().collect();
    effects.reverse();
    let backward = effects.into_iter().fold(rig::nominal(), add);
    let rows: Vec<_> = rig::flight().into_iter().take(200).collect();
    let a: Vec<Sample> = forward.run(rows.iter().copied()).collect();
    let b: Vec<Sample> = backward.run(rows).collect();
    let angle = |samples: &[Sample]| peak(samples, |sample| sample.gimbal_angle_rad);
    assert!(angle(&a) > 1e-4 && angle(&a) < 0.1);
    for (a, b) in a.iter().zip(&b) {
        rig::assert_close(a.gimbal_angle_rad, b.gimbal_angle_rad, 1e-12);
    }
}

#[test]
fn closed_form_wrong_values_are_named() {
    let plant: Plant = rig::nominal();
    let effect = |name| Effect::from_name(name).unwrap();
    let error = plant.with_effect(effect("stribeck"), &[1e-3]).unwrap_err();
    assert_eq!(error.to_string(), "`stribeck` takes 2 values; 1 are given");
    let error = plant.with_effect(effect("stribeck"), &[1e-3, 0.0]).unwrap_err();
    assert_eq!(error.to_string(), "`rate_radps` of `stribeck` is 0; it must be finite and positive");
    let error = plant.with_effect(effect("float_torque"), &[f64::NAN]).unwrap_err();
    assert!(matches!(error, EffectError::Value { parameter: "torque_nm", .. }), "{error}");
    let error = plant.with_effect(effect("motor_lag"), &[-1.0]).unwrap_err();
    assert_eq!(error.to_string(), "`servo.motor_lag_s` is 0; it must be positive and finite");
}
