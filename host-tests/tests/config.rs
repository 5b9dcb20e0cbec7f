//! Configurations: what is refused and how it is told, and that whatever builds also runs as the plant does.

use gimbal_servo::{BuildError, Config, Fixed, Interpolation};
use host_tests::Row;
use host_tests::axis::{System, run, run_plant};
use host_tests::inputs::{bare, held, rows_in};
use host_tests::random::Random;

type Set = fn(&mut Config, f64);

/// Every field that must be positive.
const POSITIVE: [(&str, Set); 23] = [
    ("servo.gimbal_inertia_kg_m2", |config, value| config.servo.gimbal_inertia_kg_m2 = value),
    ("servo.gain_nm_per_rad_s", |config, value| config.servo.gain_nm_per_rad_s = value),
    ("servo.lead_time_constants_s", |config, value| config.servo.lead_time_constants_s[0] = value),
    ("servo.lead_time_constants_s", |config, value| config.servo.lead_time_constants_s[4] = value),
    ("servo.lag_time_constants_s", |config, value| config.servo.lag_time_constants_s[0] = value),
    ("servo.lag_time_constants_s", |config, value| config.servo.lag_time_constants_s[3] = value),
    ("servo.motor_lag_s", |config, value| config.servo.motor_lag_s = value),
    ("gyro.float_inertia_kg_m2", |config, value| config.gyro.float_inertia_kg_m2 = value),
    ("gyro.damping_nm_s_per_rad", |config, value| config.gyro.damping_nm_s_per_rad = value),
    ("gyro.angular_momentum_nm_s", |config, value| config.gyro.angular_momentum_nm_s = value),
    ("gyro.stop_angle_rad", |config, value| config.gyro.stop_angle_rad = value),
    ("bearing.preload_n", |config, value| config.bearing.preload_n = value),
    ("bearing.gimbal_weight_n", |config, value| config.bearing.gimbal_weight_n = value),
    ("bearing.pitch_diameter_m", |config, value| config.bearing.pitch_diameter_m = value),
    ("bearing.load_torque_nm_per_n", |config, value| config.bearing.load_torque_nm_per_n = value),
    ("bearing.static_axial_factor", |config, value| config.bearing.static_axial_factor = value),
    ("bearing.static_radial_factor", |config, value| config.bearing.static_radial_factor = value),
    ("bearing.torque_axial_factor", |config, value| config.bearing.torque_axial_factor = value),
    ("bearing.viscosity_m2ps", |config, value| config.bearing.viscosity_m2ps = value),
    ("bearing.slip_rate_radps", |config, value| config.bearing.slip_rate_radps = value),
    ("range.radial_accel_mps2", |config, value| config.range.radial_accel_mps2 = value),
    ("range.axial_accel_mps2", |config, value| config.range.axial_accel_mps2 = value),
    ("range.rate_radps", |config, value| config.range.rate_radps = value),
];

/// Every field with ends of its own, and a value beyond each.
const RANGED: [(&str, Set, [f64; 2]); 6] = [
    ("bearing.load_exponent", |config, value| config.bearing.load_exponent = value, [-0.1, 2.1]),
    ("bearing.torque_radial_factor", |config, value| config.bearing.torque_radial_factor = value, [-0.1, 11.0]),
    ("bearing.lubrication_factor", |config, value| config.bearing.lubrication_factor = value, [-1.0, 101.0]),
    ("unbalance.x_kg_m", |config, value| config.unbalance.x_kg_m = value, [-1.1, 1.1]),
    ("unbalance.y_kg_m", |config, value| config.unbalance.y_kg_m = value, [-1.1, 1.1]),
    ("period_s", |config, value| config.period_s = value, [0.2e-3, 5e-3]),
];

fn refused(config: &Config) -> BuildError {
    let error = config.build::<f32>().expect_err("must be refused");
    let other = config.build::<Fixed>().expect_err("must be refused");
    assert_eq!(other.to_string(), error.to_string(), "both number systems say the same");
    error
}

#[test]
fn closed_form_every_impossible_value_is_refused_with_its_field() {
    for (field, set) in POSITIVE.into_iter().chain([("range.torque_nm", torque as Set)]) {
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut config = Config::consistent();
            set(&mut config, value);
            let error = refused(&config);
            assert!(matches!(error, BuildError::NotPositive { field: named, .. } if named == field), "{error:?}");
            let text = error.to_string();
            assert!(text.contains(field) && text.contains("positive") && !text.contains('\n'), "{text}");
        }
    }
    for (field, set, beyond) in RANGED {
        for value in beyond.into_iter().chain([f64::NAN, f64::INFINITY]) {
            let mut config = Config::consistent();
            set(&mut config, value);
            let error = refused(&config);
            assert!(matches!(error, BuildError::OutOfRange { field: named, .. } if named == field), "{error:?}");
            let text = error.to_string();
            assert!(text.contains(field) && text.contains("between") && !text.contains('\n'), "{text}");
        }
    }
    let mut config = Config::consistent();
    config.bearing.count = 65;
    assert!(matches!(refused(&config), BuildError::OutOfRange { field: "bearing.count", .. }));
}

fn torque(config: &mut Config, value: f64) {
    config.range.torque_nm = value;
}

/// Poles from `numpy.roots` of the characteristic polynomial `(Jg s^2 (Jo s + Bo) / H + H s) D(s) + N(s)`, N and D of
/// F(s) / (1 + T s) multiplied out: at four and ten times the gain the *consistent* loop's worst pole.
#[test]
fn cross_an_unstable_gain_is_refused_with_the_pole_that_numpy_finds() {
    for (factor, real, imag) in [(4.0, 175.616_018_6, 853.142_897_2), (10.0, 394.116_408_2, 1_075.201_463_3)] {
        let mut config = Config::consistent();
        config.servo.gain_nm_per_rad_s *= factor;
        let BuildError::UnstablePole { real_radps, imag_radps } = refused(&config) else {
            panic!("another error");
        };
        assert!((real_radps - real).abs() < 1e-6 * imag && (imag_radps - imag).abs() < 1e-6 * imag);
        let text = refused(&config).to_string();
        assert!(text.contains("unstable") && text.contains(&format!("{real:.1}")), "{text}");
    }
}

/// Upper gain margins by bisection on the same polynomial's roots: 1.562655 and 40.94021 times the gain.
#[test]
fn cross_the_gain_margin_is_where_numpy_finds_it() {
    for (config, margin) in [(Config::consistent(), 1.562_654_7), (Config::as_printed(), 40.940_212_6)] {
        for (factor, stable) in [(0.5, true), (margin * (1.0 - 1e-5), true), (margin * (1.0 + 1e-5), false)] {
            let mut config = config;
            config.servo.gain_nm_per_rad_s *= factor;
            assert_eq!(config.build::<f32>().is_ok(), stable, "{factor}");
            assert_eq!(config.build::<Fixed>().is_ok(), stable, "{factor}");
        }
    }
}

/// Equal lags have no partial fractions; they are moved apart by a part in a thousand. What that does to the loop is
/// at most its size times the loop's sensitivity, 2.1 at a phase margin of 28 degrees, and lags act above the crossover
/// only: 1e-3 of the peak for a pair, twice that for a crossover higher up. Four equal ones are moved by 0, 1, 2 and 3 thousandths: six times as much.
#[test]
fn cross_repeated_time_constants_build_and_agree_with_the_plant() {
    type Repeat = fn(&mut Config);
    let cases: [(&str, f64, Repeat); 5] = [
        ("T7 = T8", 1.2e-3, |config| config.servo.lag_time_constants_s[1] = config.servo.lag_time_constants_s[2]),
        ("T = T9", 1.2e-3, |config| config.servo.motor_lag_s = config.servo.lag_time_constants_s[3]),
        ("T5 = T8", 1e-5, |config| config.servo.lead_time_constants_s[4] = config.servo.lag_time_constants_s[2]),
        ("T7 = T8 = T9 = T", 7e-3, |config| {
            config.servo.lag_time_constants_s = [2.24, 1.5e-3, 1.5e-3, 1.5e-3];
            config.servo.motor_lag_s = 1.5e-3;
        }),
        ("T6 = T7 = 1.2 ms, T1 = T2", 2.5e-3, |config| {
            config.servo.lag_time_constants_s[0] = 1.2e-3;
            config.servo.lag_time_constants_s[1] = 1.2e-3;
            config.servo.lead_time_constants_s = [0.02, 0.02, 1.2e-3, 1.0e-3, 0.8e-3];
        }),
    ];
    for (name, bound, repeat) in cases {
        let mut config = held(bare(Config::consistent()));
        repeat(&mut config);
        config.gyro.stop_angle_rad = 0.2;
        let rows = vec![Row { torque_nm: 0.01, ..Row::default() }; 3001];
        let plant = run_plant(&config, &rows);
        for system in System::BOTH {
            let run = run(system, &config, &rows);
            let phi = run.difference(&plant, |sample| sample.gimbal_angle_rad);
            println!("{name} {}: phi off by {phi:.2e} of its peak {:.2e}", system.name(), plant.peak_phi_rad());
            let off = run.angles_off(&plant, bound);
            assert!(off.is_empty(), "{name} {}:{off}", system.name());
        }
    }
}

/// A configuration within a factor `spread` of a preset in every parameter of the loop, or nothing if it is unstable.
fn near(seed: u64, spread: f64) -> Option<Config> {
    let mut random = Random::new(seed);
    let mut config = if seed.is_multiple_of(2) { Config::consistent() } else { Config::as_printed() };
    let mut scale = |value: &mut f64| *value *= random.log_between(1.0 / spread, spread);
    scale(&mut config.servo.gimbal_inertia_kg_m2);
    scale(&mut config.servo.gain_nm_per_rad_s);
    config.servo.lead_time_constants_s.iter_mut().for_each(&mut scale);
    config.servo.lag_time_constants_s.iter_mut().for_each(&mut scale);
    scale(&mut config.servo.motor_lag_s);
    scale(&mut config.gyro.float_inertia_kg_m2);
    scale(&mut config.gyro.damping_nm_s_per_rad);
    scale(&mut config.gyro.angular_momentum_nm_s);
    scale(&mut config.gyro.stop_angle_rad);
    scale(&mut config.range.torque_nm);
    scale(&mut config.bearing.gimbal_weight_n);
    scale(&mut config.bearing.preload_n);
    scale(&mut config.bearing.slip_rate_radps);
    let periods_s = [0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3];
    config.period_s = periods_s[usize::try_from(seed % 5).expect("below 5")];
    match config.build::<Fixed>() {
        Ok(_) => Some(config),
        Err(BuildError::UnstablePole { .. }) => None,
        Err(error) => panic!("seed {seed} spread {spread}: {error}"),
    }
}

/// Torques that jump five times a second, the largest `peak_nm`.
fn jumps(config: &Config, seed: u64, peak_nm: f64) -> Vec<Row> {
    let mut random = Random::new(seed + 1000);
    let every = rows_in(0.2, config.period_s) - 1;
    let mut torque = 0.0;
    (0..rows_in(2.0, config.period_s))
        .map(|k| {
            if k % every == 0 {
                torque = random.between(-peak_nm, peak_nm);
            }
            Row { torque_nm: torque, ..Row::default() }
        })
        .collect()
}

/// How many random configurations of each spread.
const SEEDS: u64 = if cfg!(debug_assertions) { 12 } else { 120 };

/// Of the peak, for torques that bring theta to 0.8 of its stop or use the whole range. `f32`: a loop near the edge of
/// stability stores its rounding for `1 / damping` radians: 1e-4. Fixed point: 4e-9 rad of phi and 2^-28 of theta's stop for
/// what the full scales cost, ten times that where the range is far above what the loop bears, and the same 1e-4.
#[test]
fn cross_random_loops_run_as_the_plant_does() {
    for spread in [1.2, 1.5, 2.0, 3.0, 10.0] {
        let mut built = 0;
        for seed in 0..SEEDS {
            let Some(config) = near(seed, spread) else { continue };
            built += 1;
            let config = held(bare(config));
            let probe = run_plant(&config, &jumps(&config, seed, 1e-6));
            let peak_nm = (0.8e-6 * config.gyro.stop_angle_rad / probe.peak_theta_rad()).min(config.range.torque_nm);
            let rows = jumps(&config, seed, peak_nm);
            let plant = run_plant(&config, &rows);
            for system in System::BOTH {
                let run = run(system, &config, &rows);
                let case = format!("spread {spread} seed {seed} {}", system.name());
                let phi_rad = plant.peak_phi_rad() * run.difference(&plant, |sample| sample.gimbal_angle_rad);
                let theta_rad = plant.peak_theta_rad() * run.difference(&plant, |sample| sample.gyro_angle_rad);
                let phi_bound = 1e-4 * plant.peak_phi_rad() + 4e-8;
                let theta_bound = 1e-4 * plant.peak_theta_rad() + 1e-7;
                assert!(phi_rad <= phi_bound && theta_rad <= theta_bound, "{case}: {phi_rad:e} {theta_rad:e}");
                assert!(run.faults.is_empty(), "{case} {:?}", run.faults);
            }
        }
        assert!(built * 4 >= SEEDS, "spread {spread}: only {built} are stable");
    }
}

/// The same loops through saturations: a step of what brings theta 1.3 times to its stop, phi to 0.3 rad at most.
/// Contact and release are placed on a cubic through both ends of a period: good to 0.2 % for the paper's loop at 4 ms,
/// and these are up to twice as fast, which is 2^4 in the cubic's error: 3 %; where the gyro only grazes its stop its
/// small offset is off by more. At 1 ms and below by 4^-4 of that, and by what fixed point resolves of theta's excess.
#[test]
fn cross_random_loops_saturate_as_the_plant_does() {
    for spread in [1.2, 1.5, 2.0] {
        for seed in 0..SEEDS {
            let Some(config) = near(seed, spread) else { continue };
            let config = held(bare(config));
            let step = |torque_nm: f64| vec![Row { torque_nm, ..Row::default() }; rows_in(2.0, config.period_s)];
            let mut free = config;
            free.gyro.stop_angle_rad = 1.0;
            let probe = run_plant(&free, &step(1e-6));
            let torque_nm = 1.3e-6 * config.gyro.stop_angle_rad / probe.peak_theta_rad();
            if torque_nm > config.range.torque_nm {
                continue;
            }
            let plant = run_plant(&config, &step(torque_nm));
            if plant.peak_phi_rad() > 0.3 {
                continue;
            }
            for system in System::BOTH {
                let run = run(system, &config, &step(torque_nm));
                let case = format!("spread {spread} seed {seed} {} at {} s", system.name(), config.period_s);
                let off = run.difference(&plant, |sample| sample.gimbal_angle_rad);
                if off > 1e-3 {
                    println!("SAT {case}: {off:e} {:e}", plant.peak_phi_rad());
                }
                assert!(off <= 0.1, "{case}: {off:e}, {} of {} events", run.events.len(), plant.events.len());
            }
        }
    }
}

/// Friction and unbalance under a swinging load, theta off its stops: 1 % of the peak, which friction's reversal inside
/// one period makes.
#[test]
fn cross_random_platforms_with_friction_run_as_the_plant_does() {
    for spread in [1.2, 2.0] {
        for seed in 0..SEEDS {
            let Some(mut config) = near(seed, spread) else { continue };
            config.interpolation = Interpolation::Mean;
            config.period_s = config.period_s.min(1e-3);
            let rows: Vec<Row> = (0..rows_in(1.5, config.period_s))
                .map(|k| {
                    let t = k as f64 * config.period_s;
                    Row {
                        accel_x_mps2: 10.0 * (3.0 * t).sin(),
                        accel_y_mps2: 30.0 * (2.0 * t).cos(),
                        accel_z_mps2: 20.0 * (5.0 * t).sin(),
                        vehicle_rate_radps: 0.3 * (4.0 * t).cos(),
                        ..Row::default()
                    }
                })
                .collect();
            let plant = run_plant(&config, &rows);
            if !plant.events.is_empty() {
                continue;
            }
            for system in System::BOTH {
                let run = run(system, &config, &rows);
                let off = run.angles_off(&plant, 0.01);
                assert!(off.is_empty(), "spread {spread} seed {seed} {} at {} s:{off}", system.name(), config.period_s);
            }
        }
    }
}
