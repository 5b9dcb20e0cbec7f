//! What is noise of the sensors, and no gap.

use gimbal_gap::diagnose;
use gimbal_log::Column;
use gimbal_model_file::ModelFile;
use gimbal_plant::Row;
use gimbal_servo::Config;
use rand::RngExt;
use rand_distr::StandardNormal;

use crate::corpus::{self, NOISE, Simulated};
use crate::corpus::{Case, Excitation, PICKOFF_STEP_RAD, as_log, simulate};
use crate::{LEAST, SECONDS, log_with, names, of_columns, report};

/// The noise of a rate is torque wherever the bearing turns around: a loop a few per cent off rings otherwise after it.
#[test]
fn turns_of_a_platform_anywhere_in_its_tolerance_show_nothing() {
    for (excitation, seed) in [(Excitation::RateTable, 500_198), (Excitation::Flight, 500_032)] {
        let (platform, effects) = corpus::anywhere(seed);
        let case = Case { seed, excitation, seconds: SECONDS, effects, drift: 0.0, noise: 1.0 };
        let log = as_log(&corpus::simulate_platform(&case, &platform).converted());
        let diagnosis = diagnose(&log, &ModelFile::default());
        assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{seed}: {:?}", names(&diagnosis));
    }
}

/// Its lines are in what drives the platform, whatever their frequency.
#[test]
fn vibration_near_a_frequency_of_the_mains_is_no_hum() {
    for seed in [710_005, 710_008] {
        let (platform, effects) = corpus::anywhere(seed);
        let case = Case { seed, excitation: Excitation::Flight, seconds: SECONDS, effects, drift: 0.0, noise: 1.0 };
        let diagnosis =
            diagnose(&as_log(&corpus::simulate_platform(&case, &platform).converted()), &ModelFile::default());
        assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{seed}: {:#}", report(&diagnosis)["notes"]);
    }
}

/// Noise through a Butterworth filter of fourth order, its sections by the bilinear transform.
fn behind_a_filter(noise: &[f64], end_hz: f64) -> Vec<f64> {
    let tangent = (std::f64::consts::PI * end_hz * 1e-3).tan();
    let mut passed = noise.to_vec();
    for quality in [0.5412, 1.3066] {
        let scale = 1.0 / (1.0 + tangent / quality + tangent * tangent);
        let gain = tangent * tangent * scale;
        let back = [2.0 * (tangent * tangent - 1.0) * scale, (1.0 - tangent / quality + tangent * tangent) * scale];
        let (mut given, mut last) = ([0.0; 2], [0.0; 2]);
        for value in &mut passed {
            let own = gain * (*value + 2.0 * given[0] + given[1]) - back[0] * last[0] - back[1] * last[1];
            (given, last) = ([*value, given[0]], [own, last[0]]);
            *value = own;
        }
    }
    passed
}

#[test]
fn noise_of_a_sensor_behind_a_filter_is_noise() {
    let mut log = log_with(Excitation::Flight, &[]);
    let mut rng = corpus::rng(23, 7);
    let torque_nm = log.column(Column::MotorTorque).expect("the torque").to_vec();
    let noise: Vec<f64> = torque_nm.iter().map(|_| 8e-5 * rng.sample::<f64, _>(StandardNormal)).collect();
    let noisy = torque_nm.iter().zip(behind_a_filter(&noise, 150.0)).map(|(torque, noise)| torque + noise);
    log.set(Column::MotorTorque, noisy.collect());
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{:#}", report(&diagnosis)["notes"]);
}

/// What drifts of a sensor hides an effect that nobody knows, and the report says how much it does.
#[test]
fn much_slow_noise_of_a_sensor_is_told() {
    let notes = |drift_rad: f64| {
        let mut log = log_with(Excitation::Flight, &[]);
        let mut rng = corpus::rng(29, 7);
        let mut drifted_rad = 0.0;
        let drifts = |angle_rad: &f64| {
            drifted_rad += drift_rad * rng.sample::<f64, _>(StandardNormal) - 2e-3 * drifted_rad;
            angle_rad + drifted_rad
        };
        let theta_rad = log.column(Column::GyroAngle).expect("the pick-off").iter().map(drifts).collect();
        log.set(Column::GyroAngle, theta_rad);
        report(&diagnose(&log, &ModelFile::default()))["notes"].to_string()
    };
    let told = "gyro_angle_rad: below ";
    assert!(notes(4e-7).contains(told) && !notes(0.0).contains(told), "{} and {}", notes(4e-7), notes(0.0));
}

/// On a table that is tilted once the force stands still, and an unbalance would be rid of what the log has of it beside that.
#[test]
fn what_an_accelerometer_wanders_by_on_a_table_is_no_unbalance() {
    let turns = |k: u32| Row {
        accel_x_mps2: -8.0,
        accel_y_mps2: -3.0,
        accel_z_mps2: 4.75,
        vehicle_rate_radps: 0.3 * (40.0 * (1.9e-3 * f64::from(k)).sin()).tanh(),
        ..Row::default()
    };
    let rows: Vec<Row> = (0..16_000).map(turns).collect();
    let platform = corpus::drifted(&Config::consistent(), 0.6, 23);
    let mut simulated = corpus::simulate_rows(&rows, &platform, &[], 0.5, &mut corpus::rng(23, 3));
    let mut rng = corpus::rng(23, 7);
    for place in [1, 2, 3] {
        let mut wanders_mps2 = 0.0;
        for value in &mut simulated.columns[place] {
            wanders_mps2 += 2e-3 * rng.sample::<f64, _>(StandardNormal) - 1e-2 * wanders_mps2;
            *value += wanders_mps2;
        }
    }
    let diagnosis = diagnose(&as_log(&simulated), &ModelFile::default());
    assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{:?}", names(&diagnosis));
    assert!(report(&diagnosis)["notes"].to_string().contains("stands still"), "{:#}", report(&diagnosis)["notes"]);
}

/// A pick-off that steps does so in the loop, and the motor answers.
#[test]
fn steps_of_a_converter_behind_the_loop_are_no_quantised_pickoff() {
    let step_rad = 8.642e-6;
    let mut log = log_with(Excitation::Manoeuvre, &[]);
    let theta_rad = log.column(Column::GyroAngle).expect("the pick-off").to_vec();
    log.set(Column::GyroAngle, theta_rad.iter().map(|angle| (angle / step_rad).round() * step_rad).collect());
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{:?}", names(&diagnosis));
    let in_the_loop = log_with(Excitation::Manoeuvre, &[("pickoff_quantisation", vec![step_rad])]);
    assert_eq!(names(&diagnose(&in_the_loop, &ModelFile::default())), ["pickoff_quantisation"]);
}

/// A converter whose steps are as large as the noise behind the loop: the log is on its grid whether the loop is or not.
#[test]
fn steps_that_noise_hides_are_told_by_the_motor_torque() {
    let of = |effects: Vec<(&'static str, Vec<f64>)>| {
        let case =
            Case { seed: 23, excitation: Excitation::RateTable, seconds: 14.0, effects, drift: 0.6, noise: 0.15 };
        let diagnosis = diagnose(&as_log(&simulate(&case).converted()), &ModelFile::default());
        (names(&diagnosis), report(&diagnosis)["verdict"].clone())
    };
    assert_eq!(of(vec![("pickoff_quantisation", vec![PICKOFF_STEP_RAD])]).0, ["pickoff_quantisation"]);
    assert_eq!(of(Vec::new()), (Vec::new(), "no_gap".into()));
}

/// Converters of two and a half noises: where the rate has one too it is the recorder's, where the angle alone has one the
/// pick-off's. No torque tells.
#[test]
fn steps_of_an_angle_whose_rate_has_them_too_are_those_of_what_writes_the_log() {
    let case = Case {
        seed: 23,
        excitation: Excitation::Manoeuvre,
        seconds: SECONDS,
        effects: Vec::new(),
        drift: 0.6,
        noise: 1.0,
    };
    let of = |places: &[usize]| {
        let log = as_log(&on_steps(simulate(&case), 2.5, places));
        names(&diagnose(&of_columns(&log, &LEAST), &ModelFile::default()))
    };
    assert_eq!(of(&[1, 2, 3, 4, 6]), Vec::<&str>::new());
    assert_eq!(of(&[6]), ["pickoff_quantisation"]);
}

/// Angles that stay where they are for long are read a little off, each as it stands between two steps.
#[test]
fn steps_that_are_as_coarse_as_the_noise_are_no_gap() {
    let swings = |k: u32| Row {
        accel_x_mps2: 6.9,
        accel_y_mps2: 6.9,
        vehicle_rate_radps: 0.5 * (1e-3 * f64::from(k)).sin(),
        ..Row::default()
    };
    let rows: Vec<Row> = (0..30_000).map(swings).collect();
    let platform = corpus::drifted(&Config::consistent(), 0.6, 23);
    let simulated = corpus::simulate_rows(&rows, &platform, &[], 1.0, &mut corpus::rng(23, 3));
    let log = as_log(&on_steps(simulated, 4.0, &[1, 2, 3, 4, 5, 6, 7]));
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{:?}", names(&diagnosis));
}

/// Columns through converters whose steps are so many noises.
fn on_steps(mut simulated: Simulated, noises: f64, places: &[usize]) -> Simulated {
    for &place in places {
        let step = noises * NOISE[place - 1];
        simulated.columns[place].iter_mut().for_each(|value| *value = (*value / step).round() * step);
    }
    simulated
}
