//! The flight law with effects, against the reference plant with the same ones.

use gimbal_plant::{Effect, Plant, Row};
use gimbal_servo::effects::Config as Effects;
use gimbal_servo::{Config, Fixed, Input, Number};

/// One effect: its name and values in the plant's table, and the same for the flight law.
type Case = (&'static str, Vec<f64>, Effects);

fn cases() -> Vec<Case> {
    let nominal = Effects::default();
    vec![
        ("constant_torque", vec![1e-3], Effects { constant_torque_nm: 1e-3, ..nominal }),
        ("cable_spring", vec![1e-3], Effects { cable_spring_nm_per_rad: 1e-3, ..nominal }),
        ("viscous_friction", vec![1e-3], Effects { viscous_friction_nm_s_per_rad: 1e-3, ..nominal }),
        ("quadratic_drag", vec![1e-3], Effects { quadratic_drag_nm_s2_per_rad2: 1e-3, ..nominal }),
        ("anisoelasticity", vec![1e-6], Effects { anisoelasticity_nm_s4_per_m2: 1e-6, ..nominal }),
        ("stribeck", vec![6e-4, 0.05], Effects { stribeck_excess_nm: 6e-4, stribeck_rate_radps: 0.05, ..nominal }),
        ("loop_delay", vec![2e-4], Effects { loop_delay_s: 2e-4, ..nominal }),
        ("loop_delay", vec![5e-4], Effects { loop_delay_s: 5e-4, ..nominal }),
        ("torque_bias", vec![2e-4], Effects { torque_bias_nm: 2e-4, ..nominal }),
        ("torque_scale", vec![0.02], Effects { torque_scale: 0.02, ..nominal }),
        ("pickoff_bias", vec![1e-4], Effects { pickoff_bias_rad: 1e-4, ..nominal }),
        ("pickoff_scale", vec![0.02], Effects { pickoff_scale: 0.02, ..nominal }),
    ]
}

fn rows() -> Vec<Input<f64>> {
    let wave = |time_s: f64, hz: f64| (std::f64::consts::TAU * hz * time_s).sin();
    (0..6000)
        .map(|k| {
            let time_s = f64::from(k) * 1e-3;
            Input {
                accel_x_mps2: 20.0 * wave(time_s, 0.7) + 10.0 * wave(time_s, 3.1),
                accel_y_mps2: 15.0 * wave(time_s, 0.9) + 10.0,
                accel_z_mps2: 9.8,
                vehicle_rate_radps: 0.4 * wave(time_s, 0.31) + 0.1 * wave(time_s, 2.3) + 0.05,
                ..Input::default()
            }
        })
        .collect()
}

/// theta and `T_m` of the flight law.
fn flown<N: Number>(effects: &Effects) -> [Vec<f64>; 2] {
    let law = Config::consistent().build_with::<N>(effects).expect("builds");
    let units = law.axis().units();
    let mut state = law.start();
    let mut out = [Vec::new(), Vec::new()];
    for row in rows() {
        let output = units.output(&law.step(&mut state, units.input(&row)));
        out[0].push(output.gyro_angle_rad);
        out[1].push(output.motor_torque_nm);
    }
    out
}

/// The same of the plant, as its sensors log them.
fn simulated(plant: &Plant) -> [Vec<f64>; 2] {
    let rows = rows().into_iter().map(|row| Row {
        accel_x_mps2: row.accel_x_mps2,
        accel_y_mps2: row.accel_y_mps2,
        accel_z_mps2: row.accel_z_mps2,
        vehicle_rate_radps: row.vehicle_rate_radps,
        ..Row::default()
    });
    let mut out = [Vec::new(), Vec::new()];
    for sample in plant.run(rows) {
        out[0].push(sample.logged.gyro_angle_rad);
        out[1].push(sample.logged.motor_torque_nm);
    }
    out
}

fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / 6000.0).sqrt()
}

/// What an effect changes, as the law has it, is off by this share of what it changes in the plant.
fn off<N: Number>(nominal: &[[Vec<f64>; 2]; 2], case: &Case) -> [f64; 2] {
    let (name, values, effects) = case;
    let plant = Plant::new(&Config::consistent()).expect("nominal").with_tolerance(1e-9);
    let plant = plant.with_effect(Effect::from_name(name).expect("known"), values).expect("legal");
    let (flown, simulated) = (flown::<N>(effects), simulated(&plant));
    [0, 1].map(|signal| {
        let law = less(&flown[signal], &nominal[0][signal]);
        let plant = less(&simulated[signal], &nominal[1][signal]);
        // a signal that the effect does not change
        if rms(&plant) < 1e-12 { rms(&law) } else { rms(&less(&law, &plant)) / rms(&plant) }
    })
}

fn agrees<N: Number>() {
    let plant = Plant::new(&Config::consistent()).expect("nominal").with_tolerance(1e-9);
    let nominal = [flown::<N>(&Effects::default()), simulated(&plant)];
    for case in cases() {
        let [theta, torque] = off::<N>(&nominal, &case);
        println!("{:18} {:?}: theta {theta:.4}, torque {torque:.4}", case.0, case.1);
        // Where friction turns around, within the clamp's zone and a few periods, the explicit rate, the mean over a
        // period and the parabola between rows are felt: in the two effects that act there.
        let limit = if ["stribeck", "loop_delay"].contains(&case.0) { [0.03, 0.1] } else { [1e-3, 1e-3] };
        assert!(theta < limit[0] && torque < limit[1], "{}: theta {theta:.4}, torque {torque:.4}", case.0);
    }
}

#[test]
fn cross_what_an_effect_changes_is_what_it_changes_in_the_plant() {
    agrees::<f32>();
}

#[test]
fn cross_the_same_in_fixed_point() {
    agrees::<Fixed>();
}

#[test]
fn closed_form_without_effects_every_bit_is_the_nominal_laws() {
    fn same<N: Number>() {
        let config = Config::consistent();
        let (law, nominal) =
            (config.build_with::<N>(&Effects::default()).expect("builds"), config.build::<N>().expect("builds"));
        let (mut state, mut plain) = (law.start(), nominal.start());
        for row in rows() {
            let row = nominal.units().input(&row);
            assert_eq!(law.step(&mut state, row), nominal.step(&mut plain, row));
        }
    }
    same::<f32>();
    same::<Fixed>();
}

#[test]
fn contract_a_size_without_meaning_is_told_by_its_name() {
    for (effects, name) in [
        (Effects { loop_delay_s: 2e-3, ..Effects::default() }, "effects.loop_delay.delay_s"),
        (Effects { stribeck_excess_nm: 1e-3, ..Effects::default() }, "effects.stribeck.rate_radps"),
        (
            Effects { cable_spring_nm_per_rad: f64::NAN, ..Effects::default() },
            "effects.cable_spring.stiffness_nm_per_rad",
        ),
    ] {
        let told = Config::consistent().build_with::<f32>(&effects).expect_err("refused").to_string();
        assert!(told.contains(name), "{told}");
    }
}
