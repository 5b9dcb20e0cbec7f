//! How far nominal parameters may go without a gap, and what is one beyond that.

use gimbal_gap::diagnose;
use gimbal_log::Column;
use gimbal_model_file::ModelFile;
use gimbal_servo::Config;

use crate::corpus::{self, Case, Excitation, as_log, simulate};
use crate::{SECONDS, log_with, names, report};

#[test]
fn a_platform_inside_its_tolerance_has_no_gap() {
    for excitation in Excitation::ALL {
        let diagnosis = diagnose(&log_with(excitation, &[]), &ModelFile::default());
        assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{excitation:?}: {:?}", names(&diagnosis));
        assert!(names(&diagnosis).is_empty());
    }
}

#[test]
fn parameters_far_beyond_their_tolerance_are_no_nominal_ones() {
    // both together are what nominal parameters that go anywhere are, and each alone is nothing
    for excitation in [Excitation::Manoeuvre, Excitation::Flight] {
        let effects = vec![("loop_gain", vec![-0.5]), ("torque_scale", vec![-0.41])];
        let case = Case { seed: 23, excitation, seconds: 14.0, effects, drift: 0.6, noise: 0.3 };
        let mut found = names(&diagnose(&as_log(&simulate(&case)), &ModelFile::default()));
        found.sort_unstable();
        assert_eq!(found, ["loop_gain", "torque_scale"], "{excitation:?}");
    }
}

#[test]
fn a_torque_on_the_float_is_no_gap_within_the_bias_of_the_rate() {
    let mut model = ModelFile::default();
    let torque_nm = 1e-4 * model.config.gyro.angular_momentum_nm_s;
    let log = log_with(Excitation::RateTable, &[("float_torque", vec![torque_nm])]);
    assert_eq!(names(&diagnose(&log, &model)), ["float_torque"]);
    model.tolerance.vehicle_rate_bias_radps = 2e-4;
    let within = diagnose(&log, &model);
    assert_eq!(report(&within)["verdict"], "no_gap", "{:?}", names(&within));
}

/// It shifts the rate at which the bearing turns around and no more: a reference sees no drift.
#[test]
fn a_bias_of_the_rate_is_no_gap_beside_a_reference_that_sees_no_drift() {
    let case = Case {
        seed: 23,
        excitation: Excitation::RateTable,
        seconds: SECONDS,
        effects: Vec::new(),
        drift: 0.6,
        noise: 0.1,
    };
    let mut simulated = simulate(&case);
    simulated.columns[4].iter_mut().for_each(|rate_radps| *rate_radps += 1e-3);
    let mut log = as_log(&simulated);
    // a reference of 1e-5 rad
    let read = |phi_rad: &f64| 1e-5 * (phi_rad / 1e-5).round();
    log.set(Column::GimbalAngle, simulated.columns[8].iter().map(read).collect());
    let mut model = ModelFile::default();
    assert_ne!(report(&diagnose(&log, &model))["verdict"], "no_gap");
    model.tolerance.vehicle_rate_bias_radps = 2e-3;
    let within = diagnose(&log, &model);
    assert_eq!(report(&within)["verdict"], "no_gap", "{:?}", names(&within));
}

/// With every other parameter where it is nominally, what their tolerances leave open of a scale lies around the truth.
#[test]
fn a_value_beyond_what_is_realistic_is_not_pulled_back() {
    let effects = vec![("pickoff_scale", vec![-0.3])];
    let case = Case { seed: 23, excitation: Excitation::Manoeuvre, seconds: SECONDS, effects, drift: 0.0, noise: 1.0 };
    let diagnosis = diagnose(&as_log(&simulate(&case)), &ModelFile::default());
    let found = &diagnosis.decision.as_ref().expect("a decision").found;
    assert_eq!(names(&diagnosis), ["pickoff_scale"]);
    let (value, error) = (found[0].values[0], found[0].errors[0]);
    assert!((value + 0.3).abs() < 0.5 * error, "{value} +- {error}");
}

/// The clamp stands in for stiction, and nobody knows how sharp that is.
#[test]
fn a_bearing_sharper_than_the_clamp_is_no_gap() {
    for excitation in [Excitation::RateTable, Excitation::Manoeuvre] {
        let mut platform = corpus::drifted(&Config::consistent(), 0.6, 23);
        platform.bearing.slip_rate_radps *= 0.2;
        let case = Case { seed: 23, excitation, seconds: SECONDS, effects: Vec::new(), drift: 0.6, noise: 1.0 };
        let log = as_log(&corpus::simulate_platform(&case, &platform).converted());
        let diagnosis = diagnose(&log, &ModelFile::default());
        assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{excitation:?}: {:?}", names(&diagnosis));
    }
}

/// A delay of the same length, half of it pure.
#[test]
fn a_motor_whose_delay_is_pure_in_part_is_no_gap() {
    let log = log_with(Excitation::Manoeuvre, &[("loop_delay", vec![5e-4]), ("motor_lag", vec![-0.5])]);
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{:?}", names(&diagnosis));
    let mut known = ModelFile::default();
    known.known_good = vec!["motor"];
    let of_a_lag = names(&diagnose(&log, &known));
    assert!(of_a_lag.contains(&"loop_delay"), "of a motor that is known to be a lag: {of_a_lag:?}");
}
