//! `gimbal estimate` from end to end.

mod program;

use std::fmt::Write;

use program::{Bench, number};

/// A log of the model's own, with theta, motor torque and phi.
fn flown(bench: &Bench) {
    let mut text = format!("{}\n", program::HEADER);
    for k in 0..4_000_u32 {
        let t = f64::from(k) * 1e-3;
        let (y, rate) = (120.0 * (1.0 - (-3.0 * t).exp()), 0.3 * (2.0 * t).sin());
        let _ = writeln!(text, "{t},2,{y},9.8,{rate}");
    }
    bench.write("inputs.csv", text);
    bench.succeed(&["run", "inputs.csv", "--plant", "--out", "flown.csv"]);
}

#[test]
fn cross_a_log_of_the_reference_is_estimated_within_a_percent() {
    let bench = Bench::new();
    flown(&bench);
    let result = bench.json(&["estimate", "flown.csv", "--json"]);
    let (error, size) = (number(&result, "attitude_error_rms_rad"), number(&result, "attitude_rms_rad"));
    assert!(size > 1e-4 && error < 0.01 * size, "{result}");
    let (before, after) = (number(&result, "velocity_error_before_mps"), number(&result, "velocity_error_after_mps"));
    assert!(before > 1e-3 && after < 0.02 * before, "{result}");
    assert!(number(&result, "bound_coverage_2sigma") > 0.9, "{result}");
    let fixed = bench.json(&["estimate", "flown.csv", "--number", "fixed", "--json"]);
    assert!(number(&fixed, "attitude_error_rms_rad") < 0.01 * size, "{fixed}");
}

#[test]
fn contract_the_plot_shows_the_estimate_and_its_band() {
    let bench = Bench::new();
    flown(&bench);
    bench.succeed(&["estimate", "flown.csv", "--plot", "estimate.svg"]);
    let drawn = bench.read("estimate.svg");
    assert!(drawn.contains("2 sigma") && drawn.trim_end().ends_with("</svg>"));
    assert!(bench.read("flown.csv").starts_with("time_s"), "the log is not touched");
}

#[test]
fn contract_what_is_wrong_with_a_log_is_told() {
    let bench = Bench::new();
    bench.write("no-theta.csv", program::swaying(10, 1000.0));
    let told = bench.fail(2, &["estimate", "no-theta.csv"]);
    assert!(told.contains("no-theta.csv") && told.contains("gyro_angle_rad"), "{told}");
    flown(&bench);
    let told = bench.fail(2, &["estimate", "flown.csv", "--plot", "flown.csv"]);
    assert!(told.contains("flown.csv"), "{told}");
    let one: String = bench.read("flown.csv").lines().take(2).collect::<Vec<_>>().join("\n");
    bench.write("one.csv", one);
    let told = bench.fail(2, &["estimate", "one.csv"]);
    assert!(told.contains("one.csv") && told.contains("two rows"), "{told}");
}
