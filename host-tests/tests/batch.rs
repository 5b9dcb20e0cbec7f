//! Lanes of a batch against the scalar step: every output of every row, and the whole state, bit for bit.

use gimbal_servo::batch::{Baseline, Batch, Output, Processor, Rows, side_by_side};
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use gimbal_servo::{Config, Input, Interpolation, Law, State, Stop};
use host_tests::random::Random;

const LANES: usize = 16;

/// What a run met, so that no test passes for want of trouble.
#[derive(Default)]
struct Met {
    stops: u32,
    faults: u16,
}

/// Sixteen axes, no two alike; every fourth one with the other interpolation, every eighth one cross-coupled.
fn laws(interpolation: Interpolation, seed: u64) -> Vec<Law<f32>> {
    let mut random = Random::new(seed);
    let law = |lane: usize| {
        let mut config = if lane.is_multiple_of(2) { Config::consistent() } else { Config::as_printed() };
        config.interpolation = interpolation;
        if lane % 4 == 3 {
            config.interpolation = Interpolation::Held;
        }
        config.gyro.cross_coupling = lane % 8 == 7;
        config.servo.gain_nm_per_rad_s *= random.between(0.9, 1.1);
        config.gyro.damping_nm_s_per_rad *= random.between(0.9, 1.1);
        config.bearing.preload_n *= random.between(0.8, 1.2);
        config.bearing.slip_rate_radps *= random.between(0.5, 2.0);
        config.unbalance.y_kg_m = random.between(-1e-5, 1e-5);
        if lane % 8 == 4 {
            config = config.without_friction();
        }
        config.build().expect("a preset, a little changed")
    };
    (0..LANES).map(law).collect()
}

/// A row of every lane: accelerations that jump and are noisy, rates that reverse or vanish.
#[allow(clippy::cast_possible_truncation, reason = "samples are f32")]
fn rows(random: &mut Random, held: &mut [Input<f32>; LANES], largest_g: f64) -> Rows<LANES> {
    for (lane, row) in held.iter_mut().enumerate() {
        let mut signal = |size: f64| random.between(-size, size) as f32;
        if signal(1.0) > 0.99 {
            row.accel_x_mps2 = signal(0.3 * largest_g * STANDARD_GRAVITY_MPS2);
            row.accel_y_mps2 = signal(largest_g * STANDARD_GRAVITY_MPS2);
            row.accel_z_mps2 = signal(2.0 * STANDARD_GRAVITY_MPS2);
        }
        if signal(1.0) > 0.99 {
            row.vehicle_rate_radps = match lane % 3 {
                0 => signal(0.2),
                1 => signal(0.004),
                _ => signal(40.0),
            };
        }
        row.accel_y_mps2 += signal(0.02);
        row.vehicle_rate_radps += signal(1e-4);
        row.torque_nm = signal(1e-4);
        row.spin_rate_radps = signal(0.5);
    }
    side_by_side(held)
}

fn assert_same(row: u32, lane: usize, batch: &Output<'_, LANES>, scalar: &gimbal_servo::Output<f32>) {
    let pairs = [
        ("gimbal_angle_rad", batch.gimbal_angle_rad, scalar.gimbal_angle_rad),
        ("gimbal_rate_radps", batch.gimbal_rate_radps, scalar.gimbal_rate_radps),
        ("gyro_angle_rad", batch.gyro_angle_rad, scalar.gyro_angle_rad),
        ("motor_torque_nm", batch.motor_torque_nm, scalar.motor_torque_nm),
        ("friction_torque_nm", batch.friction_torque_nm, scalar.friction_torque_nm),
        ("unbalance_torque_nm", batch.unbalance_torque_nm, scalar.unbalance_torque_nm),
        ("disturbance_torque_nm", batch.disturbance_torque_nm, scalar.disturbance_torque_nm),
        ("relative_rate_radps", batch.relative_rate_radps, scalar.relative_rate_radps),
        ("stop_change_age", batch.stop_change_age, scalar.stop_change_age),
    ];
    for (name, batch, scalar) in pairs {
        let batch = batch[lane];
        assert!(batch.to_bits() == scalar.to_bits(), "row {row} lane {lane}: {name} {batch:e} {scalar:e}");
    }
    assert_eq!((batch.stop[lane], batch.faults[lane]), (scalar.stop, scalar.faults), "row {row} lane {lane}");
}

/// Runs both over rows, from the states given.
fn compare<P: Processor>(
    processor: P,
    laws: &[Law<f32>],
    mut states: [State<f32>; LANES],
    count: u32,
    mut next: impl FnMut(u32) -> Rows<LANES>,
) -> (Met, [State<f32>; LANES]) {
    let mut batch = Batch::resume(core::array::from_fn(|lane| &laws[lane]), states);
    let mut met = Met::default();
    for row in 0..count {
        let rows = next(row);
        let given = batch.step_on(processor, &rows);
        for (lane, (law, state)) in laws.iter().zip(&mut states).enumerate() {
            let output = law.step(state, rows.lane(lane));
            assert_same(row, lane, &given, &output);
            met.stops += u32::from(output.stop != Stop::Free);
            met.faults |= output.faults.bits();
        }
        if row % 997 == 0 || row + 1 == count {
            for (lane, (law, state)) in laws.iter().zip(&states).enumerate() {
                assert_eq!(law.save(&batch.state(lane)), law.save(state), "row {row} lane {lane}");
            }
        }
    }
    (met, states)
}

fn start(laws: &[Law<f32>]) -> [State<f32>; LANES] {
    core::array::from_fn(|lane| laws[lane].start())
}

#[test]
fn cross_lanes_have_the_scalar_step_s_bits_through_stops_reversals_and_rest() {
    for (interpolation, seed) in [(Interpolation::Mean, 1), (Interpolation::Held, 2)] {
        let laws = laws(interpolation, seed);
        let mut random = Random::new(seed + 10);
        let mut held = [Input::default(); LANES];
        let (met, states) = compare(Baseline, &laws, start(&laws), 6000, |_| rows(&mut random, &mut held, 45.0));
        assert!(met.stops > 100, "{} rows on a stop", met.stops);
        // And on from there, with the offsets that stops have left.
        compare(Baseline, &laws, states, 1000, |_| rows(&mut random, &mut held, 10.0));
    }
}

#[test]
fn cross_lanes_have_the_scalar_step_s_bits_on_rows_that_no_sensor_should_give() {
    let laws = laws(Interpolation::Mean, 3);
    let (mut random, mut held) = (Random::new(4), [Input::default(); LANES]);
    let (met, _) = compare(Baseline, &laws, start(&laws), 3000, |row| {
        let mut rows = rows(&mut random, &mut held, 20.0);
        let lane = row as usize % LANES;
        match row % 11 {
            0 => rows.accel_y_mps2[lane] = f32::NAN,
            1 => rows.accel_x_mps2[lane] = f32::INFINITY,
            2 => rows.vehicle_rate_radps[lane] = -1e9,
            3 => rows.accel_z_mps2[lane] = 1e4,
            4 => rows.torque_nm[lane] = f32::NEG_INFINITY,
            5 => (rows.accel_x_mps2[lane], rows.accel_y_mps2[lane]) = (480.0, 480.0),
            6 => (rows.accel_x_mps2[lane], rows.accel_y_mps2[lane]) = (0.0, -0.0),
            _ => {}
        }
        rows
    });
    // Out of range, not finite, table end.
    assert_eq!(met.faults & 0b1_1100, 0b1_1100);
}

/// The sums are brought together every 65,536 rows.
#[test]
fn cross_lanes_have_the_scalar_step_s_sums_after_a_minute() {
    let laws = laws(Interpolation::Mean, 5);
    let (mut random, mut held) = (Random::new(6), [Input::default(); LANES]);
    compare(Baseline, &laws, start(&laws), 67_000, |row| {
        // New rows seldom, so that the test is about sums.
        if row % 50 == 0 { rows(&mut random, &mut held, 12.0) } else { side_by_side(&held) }
    });
}
