//! `gimbal estimate` from end to end.

mod program;

use std::fmt::Write;

use gimbal_plant::Platform;
use gimbal_servo::platform;
use program::{Bench, number, number as number_of};

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

/// Three plants on three gimbals that turn, with noise on every reading; the outside reference is left out on demand.
fn flown_on_three_gimbals(bench: &Bench, file: &str, with_truth: bool) {
    let mut config = platform::Config::new([platform::Axis::Z, platform::Axis::X, platform::Axis::Y]);
    for gimbal in &mut config.gimbals {
        gimbal.servo.unbalance.x_kg_m *= 0.5;
    }
    bench.write("model.toml", "[unbalance]\nx_kg_m = 4.996548e-5\n");
    let plants = Platform::new(&config).expect("a preset").with_tolerance(1e-8);
    let rows: Vec<platform::Input<f64>> = (0..5_000_u32)
        .map(|k| {
            let t = f64::from(k) * 1e-3;
            platform::Input {
                accel_mps2: [5.0 * (3.0 * t).sin(), 90.0 * (1.0 - (-4.0 * t).exp()), 9.8 + 4.0 * (2.0 * t).cos()],
                vehicle_rate_radps: [0.4 * (1.7 * t).sin(), 0.3 * (2.3 * t).cos(), 0.5 * (1.1 * t).sin()],
                gimbal_angle_rad: [0.3 * t, 0.5 * (0.9 * t).sin(), -0.4 * t],
                torque_nm: [0.0; 3],
            }
        })
        .collect();
    let mut seed = 1_u64;
    let mut noise = |rms: f64| {
        // Twelve uniform numbers less six: of variance 1.
        let sum: f64 = (0..12)
            .map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                f64::from(u32::try_from(seed >> 32).expect("32 bits")) / 4_294_967_296.0
            })
            .sum();
        rms * (sum - 6.0)
    };
    let mut text = "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2".to_owned();
    for axis in ["x", "y", "z"] {
        let _ = write!(
            text,
            ",vehicle_rate_radps_{axis},relative_angle_rad_{axis},gyro_angle_rad_{axis},motor_torque_nm_{axis}"
        );
        if with_truth {
            let _ = write!(text, ",gimbal_angle_rad_{axis}");
        }
    }
    for (k, (row, sample)) in rows.iter().zip(plants.run(rows.iter().copied())).enumerate() {
        let _ = write!(text, "\n{}", k as f64 * 1e-3);
        for accel in row.accel_mps2 {
            let _ = write!(text, ",{}", accel + noise(0.01));
        }
        for axis in 0..3 {
            let of = &sample.axes[axis];
            let (theta, torque) = (of.gyro_angle_rad + noise(2e-6), of.motor_torque_nm + noise(1e-5));
            let rate = row.vehicle_rate_radps[axis] + noise(2e-4);
            let _ = write!(text, ",{rate},{},{theta},{torque}", row.gimbal_angle_rad[axis]);
            if with_truth {
                let _ = write!(text, ",{}", sample.attitude_error_rad[axis]);
            }
        }
    }
    bench.write(file, text + "\n");
}

#[test]
fn cross_a_log_of_three_gimbals_is_estimated_within_a_percent() {
    let bench = Bench::new();
    flown_on_three_gimbals(&bench, "three.csv", true);
    let call = ["estimate", "three.csv", "--gimbals", "zxy", "--model", "model.toml", "--json"];
    for number in ["f32", "fixed"] {
        let result = bench.json(&[&call[..], &["--number", number, "--plot", "three.svg"]].concat());
        assert_eq!(result["axes"], 3);
        let (error, size) = (number_of(&result, "attitude_error_rms_rad"), number_of(&result, "attitude_rms_rad"));
        assert!(size > 1e-4 && error < 0.01 * size, "{result}");
        let before = number_of(&result, "velocity_error_before_mps");
        assert!(before > 1e-2 && number_of(&result, "velocity_error_after_mps") < 0.02 * before, "{result}");
        assert!(number_of(&result, "bound_coverage_2sigma") > 0.93, "{result}");
    }
    let drawn = bench.read("three.svg");
    assert!(["phi about x", "phi about y", "phi about z"].iter().all(|title| drawn.contains(title)));
    // With the gimbals in another order the forces and rates are not those that acted.
    let wrong = bench.json(&["estimate", "three.csv", "--model", "model.toml", "--json"]);
    let right = bench.json(&call);
    let error = |result: &serde_json::Value| number_of(result, "attitude_error_rms_rad");
    assert!(error(&wrong) > 3.0 * error(&right), "{wrong} {right}");
    // Without a reference three plants stand in for it; their inputs are the noisy ones.
    flown_on_three_gimbals(&bench, "bare.csv", false);
    let bare = bench.json(&["estimate", "bare.csv", "--gimbals", "zxy", "--model", "model.toml", "--json"]);
    assert!(error(&bare) < 0.05 * number_of(&bare, "attitude_rms_rad"), "{bare}");
}

#[test]
fn contract_what_is_wrong_with_a_log_of_three_axes_is_told() {
    let bench = Bench::new();
    flown_on_three_gimbals(&bench, "three.csv", true);
    let text = bench.read("three.csv").replace("gyro_angle_rad_y", "theta_y");
    bench.write("lacks.csv", text);
    let told = bench.fail(2, &["estimate", "lacks.csv"]);
    assert!(told.contains("lacks.csv: line 1: there is no column `gyro_angle_rad_y`"), "{told}");
    let text = bench.read("three.csv").replace("\n0.002,", "\n0.002,x");
    bench.write("text.csv", text);
    let told = bench.fail(2, &["estimate", "text.csv"]);
    assert!(told.contains("text.csv: line 4, column 2 (accel_x_mps2)"), "{told}");
    assert!(bench.fail(2, &["estimate", "three.csv", "--gimbals", "xyx"]).contains("each of x, y and z once"));
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
