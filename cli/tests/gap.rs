//! `gimbal gap`: corrected models, known parts, several logs.

mod program;

use std::fmt::Write;

use gimbal_plant::{Effect, Plant, Row};
use gimbal_servo::Config;
use program::{Bench, HEADER, number};

/// A log of the plant with an effect, 12 s with little noise.
fn logged(effect: &str, values: &[f64], phase: f64) -> String {
    let plant = Plant::new(&Config::consistent()).expect("nominal").with_tolerance(1e-8);
    let plant = plant.with_effect(Effect::from_name(effect).expect("known"), values).expect("legal");
    let wave = |time_s: f64, hz: f64| (std::f64::consts::TAU * hz * time_s + phase).sin();
    let rows = (0..12_000).map(|k| {
        let time_s = f64::from(k) * 1e-3;
        Row {
            accel_x_mps2: 20.0 * wave(time_s, 0.7) + 10.0 * wave(time_s, 3.1),
            accel_y_mps2: 15.0 * wave(time_s, 0.9) + 10.0 * wave(time_s, 5.3),
            accel_z_mps2: 9.8 + 3.0 * wave(time_s, 1.3),
            vehicle_rate_radps: 0.4 * wave(time_s, 0.31) + 0.3 * wave(time_s, 2.3) + 0.1 * wave(time_s, 5.9),
            ..Row::default()
        }
    });
    let mut text = format!("{HEADER},gyro_angle_rad,motor_torque_nm\n");
    let mut seed = 1_u64;
    let mut noise = |sigma: f64| {
        let mut sum = -6.0;
        for _ in 0..12 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum += (seed >> 33) as f64 / f64::from(1_u32 << 31);
        }
        sigma * sum
    };
    for (k, sample) in plant.run(rows).enumerate() {
        let row = sample.logged.inputs;
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{}",
            k as f64 * 1e-3,
            row.accel_x_mps2 + noise(0.01),
            row.accel_y_mps2 + noise(0.01),
            row.accel_z_mps2 + noise(0.01),
            row.vehicle_rate_radps + noise(1e-4),
            sample.logged.gyro_angle_rad + noise(2e-6),
            sample.logged.motor_torque_nm + noise(1e-5),
        );
    }
    text
}

#[test]
fn contract_the_corrected_model_runs_and_has_no_gap() {
    let bench = Bench::new();
    bench.write("log.csv", logged("gyro_damping", &[0.25], 0.0));
    let first = bench.json(&["gap", "log.csv", "--write-model", "corrected.toml", "--json"]);
    assert_eq!(first["effects"][0]["name"], "gyro_damping", "{first:#}");
    let text = bench.read("corrected.toml");
    let line = text.lines().find(|line| line.starts_with("damping_nm_s_per_rad")).expect("the parameter");
    assert!(line.contains("fitted to the log; was 0.00926"), "{line}");
    let value: f64 = line.split(['=', '#']).nth(1).expect("a value").trim().parse().expect("a number");
    assert!((value / (1.25 * 9.27e-3) - 1.0).abs() < 0.02, "{line}");
    let second = bench.json(&["gap", "log.csv", "--model", "corrected.toml", "--json"]);
    assert_eq!(second["verdict"], "no_gap", "{second:#}");
    // What the flight law makes of it is what the log has, all along: a fourteenth of the gap is the log's noise, and as much
    // goes with what is fitted and no parameter of the file.
    let column = |file: &str, place: usize| -> Vec<f64> {
        let cell = |line: &str| line.split(',').nth(place).expect("a cell").parse().expect("a number");
        bench.read(file).lines().skip(1).map(cell).collect()
    };
    let measured = column("log.csv", 5);
    let off = |model: &[&str]| -> f64 {
        bench.succeed(&[&["run", "log.csv", "--out", "run.csv"], model].concat());
        let run = column("run.csv", 6);
        run.iter().zip(&measured).map(|(run, measured)| (run - measured).powi(2)).sum::<f64>().sqrt()
    };
    let (nominal, corrected) = (off(&[]), off(&["--model", "corrected.toml"]));
    assert!(corrected < 0.2 * nominal, "{corrected} of {nominal}");
}

#[test]
fn contract_wrong_calls_are_told() {
    let bench = Bench::new();
    bench.write("log.csv", program::swaying(100, 1000.0));
    let told = bench.fail(2, &["gap", "log.csv", "--trust", "torque_senser"]);
    assert!(told.contains("--trust: `torque_senser` is not a part") && told.contains("`torque_sensor`"), "{told}");
    let told = bench.fail(2, &["gap", "log.csv", "--write-model", "log.csv"]);
    assert!(told.contains("is the file that is read"), "{told}");
    bench.write("m.toml", "[effects]\ncable_spring = { stiffness_nm_per_rad = 1e-3 }\n");
    let told = bench.fail(2, &["estimate", "log.csv", "--model", "m.toml"]);
    assert!(told.contains("`gimbal estimate` does not take `effects.cable_spring`"), "{told}");
}

#[test]
fn cross_effects_of_a_model_file_reach_the_flight_law_and_the_plant() {
    let bench = Bench::new();
    bench.write("log.csv", program::swaying(4000, 1000.0));
    bench.write(
        "m.toml",
        "[effects]\ncable_spring = { stiffness_nm_per_rad = 0.2 }\nconstant_torque = { torque_nm = 5e-3 }\n",
    );
    let peak =
        |more: &[&str]| number(&bench.json(&[&["run", "log.csv", "--json"], more].concat()), "peak_gimbal_angle_rad");
    let (nominal, law) = (peak(&[]), peak(&["--model", "m.toml"]));
    let plant = [peak(&["--plant"]), peak(&["--model", "m.toml", "--plant"])];
    assert!((law - nominal).abs() > 0.02 * nominal);
    assert!(((law - nominal) / (plant[1] - plant[0]) - 1.0).abs() < 0.05, "{nominal} {law} {plant:?}");
    let fixed = peak(&["--model", "m.toml", "--number", "fixed"]);
    assert!((fixed / law - 1.0).abs() < 1e-4, "{fixed} {law}");
    // What the law cannot do is told.
    bench.write("m.toml", "[effects]\ndead_zone = { width_nm = 1e-4 }\n");
    let run = bench.run(&["run", "log.csv", "--model", "m.toml"]);
    assert!(String::from_utf8_lossy(&run.stdout).contains("the flight law leaves out dead_zone; --plant has it"));
}

#[test]
fn contract_several_logs_are_taken_together() {
    let bench = Bench::new();
    for (name, phase) in [("a.csv", 0.0), ("b.csv", 1.0)] {
        bench.write(name, logged("gyro_damping", &[0.25], phase));
    }
    let all = bench.json(&["gap", "a.csv", "b.csv", "--out", "out", "--json"]);
    assert_eq!((&all["schema"], all["logs"].as_array().map(Vec::len)), (&"gimbal-gap-pool/1".into(), Some(2)));
    let pooled = &all["pooled"];
    assert_eq!(pooled["sets"][0]["effects"][0], "gyro_damping", "{pooled:#}");
    let own = &pooled["parameters"][0];
    assert_eq!((&own["drifts"], own["logs"].as_array().map(Vec::len)), (&false.into(), Some(2)), "{own:#}");
    assert!((number(own, "value") - 0.25).abs() < 0.02, "{own:#}");
    for log in pooled["unseen"].as_array().expect("logs") {
        let theta = &log["signals"][0];
        assert!(number(theta, "after") < 0.3 * number(theta, "before"), "{log:#}");
    }
    let page = bench.read("out/pooled.html");
    assert!(page.contains("Parameters from run to run") && !page.contains("http"), "{page}");
    for folder in ["out/a", "out/b"] {
        assert!(bench.read(&format!("{folder}/gap.html")).contains("figure class=\"chart\""));
        let report: serde_json::Value = serde_json::from_str(&bench.read(&format!("{folder}/gap.json"))).expect("JSON");
        assert_eq!(report["schema"], "gimbal-gap/1");
    }
}
