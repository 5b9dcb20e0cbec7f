//! What holds for any input at all: finite, absurd or not a number.

use gimbal_servo::paper::STANDARD_GRAVITY_MPS2 as G;
use gimbal_servo::{Config, Digest, Faults, Fixed, Input, Law, Number, Output, RestoreError, State};
use host_tests::axis::{Axis, Run, System, run};
use host_tests::inputs::{bare, friction_profile, manoeuvre, torque_step, unbalance_profile};
use host_tests::{Row, axis};
use proptest::prelude::*;

type Change = fn(&mut Config);
type Set = fn(&mut Row, f64);

/// Rows of a run.
const ROWS: usize = 300;
const CASES: u32 = if cfg!(debug_assertions) { 40 } else { 400 };

/// Any value of a signal: mostly in range, often at its ends, sometimes absurd.
fn value(range: f64) -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -range..range,
        2 => prop_oneof![Just(range), Just(-range), Just(0.0), Just(1e-3 * range)],
        1 => -1e3 * range..1e3 * range,
        1 => any::<u32>().prop_map(|bits| f64::from(f32::from_bits(bits))),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e300), Just(5e-324)],
    ]
}

fn row() -> impl Strategy<Value = Row> {
    let accel = 50.0 * G;
    (value(accel), value(accel), value(20.0 * G), value(52.0), value(0.05), value(52.0)).prop_map(
        |(accel_x_mps2, accel_y_mps2, accel_z_mps2, vehicle_rate_radps, torque_nm, spin_rate_radps)| Row {
            accel_x_mps2,
            accel_y_mps2,
            accel_z_mps2,
            vehicle_rate_radps,
            torque_nm,
            spin_rate_radps,
            ..Row::default()
        },
    )
}

/// Rows that are held for a while each, so that loads act long enough to bring the gyro to its stops.
fn rows() -> impl Strategy<Value = Vec<Row>> {
    prop::collection::vec((row(), 1_usize..60), 1..40).prop_map(|spans| {
        spans.into_iter().flat_map(|(row, count)| std::iter::repeat_n(row, count)).take(ROWS).collect()
    })
}

fn config() -> impl Strategy<Value = Config> {
    let periods = prop_oneof![Just(0.25e-3), Just(0.5e-3), Just(1e-3), Just(2e-3), Just(4e-3)];
    (periods, any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>(), 0.5_f64..2.0).prop_map(
        |(period_s, printed, friction, coupled, held, stop)| {
            let mut config = if printed { Config::as_printed() } else { Config::consistent() };
            config.period_s = period_s;
            config.gyro.cross_coupling = coupled;
            config.gyro.stop_angle_rad *= stop;
            if !friction {
                config = config.without_friction();
            }
            if held { host_tests::inputs::held(config) } else { config }
        },
    )
}

/// One step's output is possible.
fn check<N: Number>(config: &Config, axis: &Axis<N>, output: &Output<N>) -> Result<(), TestCaseError> {
    let si = axis.law.units().output(output);
    let signals = [
        si.gimbal_angle_rad,
        si.gimbal_rate_radps,
        si.gyro_angle_rad,
        si.motor_torque_nm,
        si.friction_torque_nm,
        si.unbalance_torque_nm,
        si.disturbance_torque_nm,
        si.relative_rate_radps,
        si.stop_change_age,
    ];
    prop_assert!(signals.iter().all(|signal| signal.is_finite()), "{si:?}");
    let errors = [axis.law.velocity_error_mps(&axis.state), axis.law.position_error_m(&axis.state)];
    prop_assert!(errors.as_flattened().iter().all(|error| error.is_finite()), "{errors:?}");
    // The stop as the number system holds it: half a bit of f32 above.
    prop_assert!(si.gyro_angle_rad.abs() <= config.gyro.stop_angle_rad * (1.0 + 6e-8) + 1e-9, "{si:?}");
    prop_assert!(si.gimbal_angle_rad.abs() <= 1.0, "{si:?}");
    prop_assert!(si.friction_torque_nm * si.relative_rate_radps >= 0.0, "{si:?}");
    prop_assert!((0.0..=1.0).contains(&si.stop_change_age), "{si:?}");
    Ok(())
}

fn possible<N: Number>(config: &Config, rows: &[Row]) -> Result<(), TestCaseError> {
    let mut axis = Axis::<N>::new(config).unwrap();
    for row in rows {
        let input = axis.law.units().input(&axis::si(row));
        let output = axis.law.step(&mut axis.state, input);
        check(config, &axis, &output)?;
    }
    Ok(())
}

fn digest<N: Number>(law: &Law<N>, state: &mut State<N>, inputs: &[Input<N>]) -> u64 {
    let mut digest = Digest::default();
    for input in inputs {
        digest.add_output(&law.step(state, *input));
    }
    digest.value()
}

/// Saving, restoring and going on is the same as going on.
fn replays<N: Number>(config: &Config, rows: &[Row], at: usize) -> Result<(), TestCaseError> {
    let law: Law<N> = config.build().unwrap();
    let inputs: Vec<Input<N>> = rows.iter().map(|row| law.units().input(&axis::si(row))).collect();
    let (first, rest) = inputs.split_at(at.min(inputs.len()));
    let mut state = law.start();
    digest(&law, &mut state, first);
    let bytes = law.save(&state);
    let mut restored = law.restore(&bytes).map_err(|error| TestCaseError::fail(error.to_string()))?;
    prop_assert_eq!(law.save(&restored), bytes);
    prop_assert_eq!(digest(&law, &mut restored, rest), digest(&law, &mut state, rest));
    prop_assert_eq!(law.save(&restored), law.save(&state));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: CASES, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn closed_form_every_output_is_possible(config in config(), rows in rows()) {
        possible::<f32>(&config, &rows)?;
        possible::<Fixed>(&config, &rows)?;
    }

    #[test]
    fn closed_form_a_restored_state_goes_on_bit_for_bit(config in config(), rows in rows(), at in 0..ROWS) {
        replays::<f32>(&config, &rows, at)?;
        replays::<Fixed>(&config, &rows, at)?;
    }

    /// Any fraction at all as input: no full scale is left out.
    #[test]
    fn closed_form_any_raw_bits_are_taken(config in config(), raw in prop::collection::vec(any::<[i32; 6]>(), 1..200)) {
        let mut axis = Axis::<Fixed>::new(&config).unwrap();
        let mut single = Axis::<f32>::new(&config).unwrap();
        for bits in raw {
            let [x, y, z, rate, torque, spin] = bits.map(Fixed::from_raw);
            let output = axis.law.step(&mut axis.state, Input {
                accel_x_mps2: x,
                accel_y_mps2: y,
                accel_z_mps2: z,
                vehicle_rate_radps: rate,
                torque_nm: torque,
                spin_rate_radps: spin,
            });
            check(&config, &axis, &output)?;
            let [x, y, z, rate, torque, spin] = bits.map(|bits| f32::from_bits(bits.cast_unsigned()));
            let output = single.law.step(&mut single.state, Input {
                accel_x_mps2: x,
                accel_y_mps2: y,
                accel_z_mps2: z,
                vehicle_rate_radps: rate,
                torque_nm: torque,
                spin_rate_radps: spin,
            });
            check(&config, &single, &output)?;
        }
    }

    /// One changed bit anywhere, and bytes that never were a state.
    #[test]
    fn closed_form_damaged_bytes_are_refused(bit in 0..8 * gimbal_servo::SAVED_LEN, noise in any::<u64>()) {
        let law: Law<f32> = Config::consistent().build().unwrap();
        let mut state = law.start();
        for row in manoeuvre(0.05, 1e-3, 3) {
            law.step(&mut state, law.units().input(&axis::si(&row)));
        }
        let mut bytes = law.save(&state);
        bytes[bit / 8] ^= 1 << (bit % 8);
        prop_assert!(law.restore(&bytes).is_err());
        let mut random = host_tests::random::Random::new(noise);
        let foreign: gimbal_servo::Saved = core::array::from_fn(|_| random.bits().to_le_bytes()[0]);
        prop_assert_eq!(law.restore(&foreign).unwrap_err(), RestoreError::NotAState);
    }
}

#[test]
fn closed_form_a_state_of_another_law_is_refused() {
    let law: Law<f32> = Config::consistent().build().unwrap();
    let bytes = law.save(&law.start());
    assert_eq!(law.restore(&bytes).unwrap(), law.start());
    let other: Law<Fixed> = Config::consistent().build().unwrap();
    assert_eq!(other.restore(&bytes).unwrap_err(), RestoreError::OtherNumberSystem);
    let changes: [Change; 8] = [
        |config| config.period_s = 2e-3,
        |config| config.gyro.cross_coupling = true,
        |config| config.interpolation = gimbal_servo::Interpolation::Held,
        |config| config.servo.lead_time_constants_s[4] *= 1.0 + 1e-15,
        |config| config.bearing.count = 3,
        |config| config.bearing.viscous_law = gimbal_servo::bearing::ViscousLaw::Metric,
        |config| config.unbalance.y_kg_m = 1e-9,
        |config| config.range.rate_radps = 50.0,
    ];
    for change in changes {
        let mut config = Config::consistent();
        change(&mut config);
        let other: Law<f32> = config.build().unwrap();
        assert_eq!(other.restore(&bytes).unwrap_err(), RestoreError::OtherLaw);
    }
}

/// The bits that one row sets on a law at rest.
fn bits_of<N: Number>(config: &Config, row: &Row) -> Faults {
    Axis::<N>::new(config).unwrap().step(row).faults
}

#[test]
fn closed_form_an_input_beyond_its_range_is_clamped_and_told() {
    let config = Config::consistent();
    let cases: [(Set, f64); 6] = [
        (|row, value| row.accel_x_mps2 = value, 50.0 * G),
        (|row, value| row.accel_y_mps2 = value, 50.0 * G),
        (|row, value| row.accel_z_mps2 = value, 20.0 * G),
        (|row, value| row.vehicle_rate_radps = value, 3000.0_f64.to_radians()),
        (|row, value| row.torque_nm = value, 0.05),
        (|row, value| row.spin_rate_radps = value, 3000.0_f64.to_radians()),
    ];
    for (set, limit) in cases {
        for (share, expected) in [(0.999, Faults::NONE), (-0.999, Faults::NONE), (1.001, Faults::INPUT_OUT_OF_RANGE)] {
            let mut row = Row::default();
            set(&mut row, share * limit);
            assert_eq!(bits_of::<f32>(&config, &row), expected, "{row:?}");
            assert_eq!(bits_of::<Fixed>(&config, &row), expected, "{row:?}");
        }
        // Not a number, and without end.
        for absurd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut row = Row::default();
            set(&mut row, absurd);
            assert_eq!(bits_of::<f32>(&config, &row), Faults::INPUT_NOT_FINITE, "{row:?}");
            assert_eq!(bits_of::<Fixed>(&config, &row), Faults::INPUT_NOT_FINITE, "{row:?}");
        }
    }
}

fn skips_holes<N: Number>() {
    let config = Config::consistent();
    let (mut holed, mut repeated) = (Axis::<N>::new(&config).unwrap(), Axis::<N>::new(&config).unwrap());
    let rows = manoeuvre(0.5, 1e-3, 9);
    let mut last = rows[0];
    for (k, row) in rows.iter().enumerate() {
        let hole = k % 17 == 5;
        let broken = Row {
            accel_x_mps2: f64::NAN,
            accel_y_mps2: f64::INFINITY,
            accel_z_mps2: f64::NAN,
            vehicle_rate_radps: f64::NEG_INFINITY,
            torque_nm: f64::NAN,
            ..Row::default()
        };
        if !hole {
            last = *row;
        }
        let seen = holed.step(if hole { &broken } else { row });
        let told = repeated.step(&last);
        assert_eq!(seen.gimbal_angle_rad.to_bits(), told.gimbal_angle_rad.to_bits(), "row {k}");
        assert_eq!(seen.faults.contains(Faults::INPUT_NOT_FINITE), hole, "row {k}");
    }
}

/// The last good row goes on acting: a run with holes is the run with the row before repeated.
#[test]
fn closed_form_a_row_that_is_not_a_number_repeats_the_last_good_one() {
    skips_holes::<f32>();
    skips_holes::<Fixed>();
}

/// `A_r` of 64 and 70 g from components inside their ranges: beyond the tables, which are read at their end.
#[test]
fn closed_form_a_load_beyond_the_tables_is_told() {
    let config = Config::consistent();
    for (accel_g, expected) in [(35.0, Faults::NONE), (45.0, Faults::TABLE_END), (49.9, Faults::TABLE_END)] {
        let rate = 0.1;
        let row =
            Row { accel_x_mps2: accel_g * G, accel_y_mps2: -accel_g * G, vehicle_rate_radps: rate, ..Row::default() };
        let radial_mps2 = (2.0_f64.sqrt() * accel_g).min(50.0) * G;
        let level = config.bearing.friction_level_nm(radial_mps2, 0.0, rate);
        let (mut single, mut fixed) = (Axis::<f32>::new(&config).unwrap(), Axis::<Fixed>::new(&config).unwrap());
        for output in [single.step(&row), fixed.step(&row)] {
            assert_eq!(output.faults, expected, "{accel_g} g");
            assert!((output.friction_torque_nm / level - 1.0).abs() < 1e-3, "{accel_g} g");
        }
    }
}

fn first_set(run: &Run, bit: Faults) -> Option<usize> {
    run.samples.iter().position(|sample| sample.faults.contains(bit))
}

/// 4e5 dyne cm: theta on its stop, phi past 0.1 rad, the offset left behind, in this order; each bit exactly while its
/// statement is true.
#[test]
fn closed_form_bits_of_a_saturation_say_what_the_signals_show() {
    let config = bare(Config::consistent());
    for system in System::BOTH {
        let run = run(system, &config, &torque_step(4e5, 2.0, 1e-3));
        for sample in &run.samples {
            let on_stop = sample.gyro_angle_rad.abs() >= config.gyro.stop_angle_rad * (1.0 - 1e-7);
            assert_eq!(sample.faults.contains(Faults::GYRO_SATURATED), on_stop, "{sample:?}");
            let large = sample.gimbal_angle_rad.abs() > 0.1;
            assert_eq!(sample.faults.contains(Faults::SMALL_ANGLE_EXCEEDED), large, "{sample:?}");
            assert!(!sample.faults.contains(Faults::ARITHMETIC_SATURATED), "{sample:?}");
        }
        let release = run.events[1].time_s;
        let offset_from = first_set(&run, Faults::OFFSET_LEFT).unwrap();
        // The first sample after the release.
        let late = offset_from as f64 - release * 1e3;
        assert!((0.0..1.0).contains(&late), "{late}");
        assert!(run.samples[offset_from..].iter().all(|sample| sample.faults.contains(Faults::OFFSET_LEFT)));
    }
}

/// 5e5 dyne cm turns phi past 1 rad, where it stays and says so: also on a loop whose modes need a larger full scale.
#[test]
fn closed_form_phi_ends_at_one_radian_and_is_told() {
    let mut wide = bare(Config::as_printed());
    wide.gyro.angular_momentum_nm_s *= 0.5;
    assert!(wide.build::<Fixed>().unwrap().units().gimbal_angle > 0, "phi's full scale is beyond 1 rad");
    let loops = [bare(Config::consistent()), bare(Config::as_printed()), wide];
    for config in loops {
        for system in System::BOTH {
            let run = run(system, &config, &torque_step(4.99e5, 6.0, 1e-3));
            let case = format!("{} {:?}", system.name(), config.gyro);
            let peak = run.peak_phi_rad();
            assert!(peak <= 1.0 && peak > 0.999_999, "{case}: {peak}");
            let full = first_set(&run, Faults::ARITHMETIC_SATURATED).expect("the bit");
            assert!(run.samples[full].gimbal_angle_rad.abs() > 0.999_999, "{case}");
            assert!(run.samples[full - 1].gimbal_angle_rad.abs() < 1.0, "{case}");
        }
    }
}

/// The paper's runs and a manoeuvre: nothing to tell.
#[test]
fn closed_form_clean_runs_set_no_bit() {
    let config = Config::consistent();
    for rows in [unbalance_profile(12.0, 1e-3), friction_profile(12.0, 1e-3), manoeuvre(5.0, 1e-3, 4)] {
        for system in System::BOTH {
            assert_eq!(run(system, &config, &rows).faults, Faults::NONE, "{}", system.name());
        }
    }
}
