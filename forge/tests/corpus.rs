//! A corpus can be made again bit for bit, has the shares it promises, and knows every effect of the contract.

use gimbal_forge::corpus::{Kind, Recipe, kinds, make};
use gimbal_forge::effects::{BEYOND, Effect, World, library_names};
use gimbal_forge::excitation::Excitation;
use gimbal_forge::scene::Scene;
use gimbal_forge::sensors::Sensors;
use gimbal_forge::{Draw, Truth};
use gimbal_servo::Config;

#[test]
fn contract_the_same_seed_gives_the_same_bytes() {
    let seed = Draw::seed_of(3);
    let recipe = Recipe::scoring(20, seed, (6.0, 6.0), None);
    let other = Recipe { seed: Draw::seed_of(4), ..recipe.clone() };
    for (kind, index) in [(Kind::Nothing, 0), (Kind::One, 1)] {
        let (first, second) = (make(&recipe, kind, index), make(&recipe, kind, index));
        assert_eq!((&first.csv, &first.model), (&second.csv, &second.model));
        assert_eq!(
            serde_json::to_string(&first.answer).expect("JSON"),
            serde_json::to_string(&second.answer).expect("JSON")
        );
        assert_ne!(first.csv, make(&other, kind, index).csv);
        // the header of the contract, one row a millisecond
        let needed = "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps,gyro_angle_rad";
        assert!(first.csv.starts_with(needed));
        assert_eq!(first.csv.lines().count(), 6001);
        assert_eq!(first.answer.effects.len(), usize::from(kind == Kind::One));
    }
}

#[test]
fn contract_the_shares_are_those_promised() {
    let of = |logs, seed| kinds(&Recipe::scoring(logs, Draw::seed_of(seed), (6.0, 6.0), None));
    for (logs, counts) in [(1500, [300, 600, 300, 75, 225]), (150, [30, 59, 30, 8, 23])] {
        let kinds = of(logs, 1);
        for (kind, count) in Kind::ALL.into_iter().zip(counts) {
            assert_eq!(kinds.iter().filter(|other| **other == kind).count(), count, "{}", kind.name());
        }
    }
    assert_ne!(of(150, 1), of(150, 2));
    let singles = Recipe { shares: [0, 100, 0, 0, 0], ..Recipe::scoring(30, Draw::seed_of(1), (6.0, 6.0), None) };
    assert!(kinds(&singles).iter().all(|kind| *kind == Kind::One));
}

#[test]
fn contract_every_name_of_the_table_is_there() {
    // the table of the contract, name by name
    let table = "friction_level viscous_friction stribeck presliding load_dependence direction_asymmetry \
                 quadratic_drag friction_drift mass_unbalance anisoelasticity cable_spring cable_hysteresis \
                 torque_ripple constant_torque cross_axis_coupling loop_gain loop_delay motor_lag torque_saturation \
                 dead_zone pickoff_quantisation gyro_damping angular_momentum stop_angle float_torque \
                 g_sensitive_float_torque gimbal_inertia flexible_mode pickoff_scale pickoff_bias torque_scale \
                 torque_bias time_skew";
    assert_eq!(table.split_whitespace().collect::<Vec<_>>(), library_names().collect::<Vec<_>>());
    assert!(BEYOND.iter().all(|name| !table.contains(name)));
}

#[test]
fn closed_form_every_effect_changes_what_is_logged() {
    let mut draw = Draw::new(&Draw::seed_of(21), 0);
    let scene = Scene { track: Excitation::Manoeuvre.track(9000, None, &mut draw), before: 0 };
    let mut base = World { truth: Truth::new(&Config::consistent()), sensors: Sensors::default() };
    // so that the manoeuvre reaches the stops, and their angle matters
    base.truth.config.gyro.stop_angle_rad = 3e-4;
    let show = |world: &World| {
        // logged inputs against true ones stand for what `time_skew` changes
        let track = world.sensors.logged(&scene.track);
        Scene::outputs(world, &scene.run(&world.truth, &track, 6))
    };
    let plain = show(&base);
    let scale = scene.scale(&scene.run(&base.truth, &scene.track, 6));
    for name in library_names().chain(BEYOND) {
        let effect = Effect::plain(name);
        let range = effect.range();
        let mut world = base.clone();
        effect.apply((range.small * range.largest).sqrt(), &scale, &mut world);
        let shown = show(&world);
        assert!(shown.iter().flatten().all(|value| value.is_finite()), "{name}");
        assert!(shown != plain, "{name} changes nothing");
        assert!(!effect.parameters(1.0, &scale).is_empty());
    }
}
