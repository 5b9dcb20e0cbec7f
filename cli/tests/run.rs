//! `gimbal run`: the paper's cases, torque steps, logs.

mod program;

use std::fmt::Write;

use program::{Bench, number, swaying};

const DEGREE_RAD: f64 = std::f64::consts::PI / 180.0;

#[test]
fn paper_unbalance_case_meets_figure_7_but_for_the_open_difference() {
    let bench = Bench::new();
    for number_system in ["f32", "fixed"] {
        let run = bench.json(&["run", "--json", "--number", number_system]);
        assert_eq!(run["number"], number_system);
        // Figure 7: 0.11 deg, not limited. The model's own figures (0.1110 deg, 0.479 deg, 0.1072 m/s) to their last digit.
        assert!((number(&run, "peak_gimbal_angle_rad") / DEGREE_RAD - 0.1110).abs() < 1e-4);
        assert!((number(&run, "peak_gyro_angle_rad") / DEGREE_RAD - 0.479).abs() < 1e-3);
        assert!((number(&run, "velocity_error_mps") - 0.1072).abs() < 1e-4);
        assert!(number(&run, "time_on_stop_s").abs() < 1e-12);
        // The velocity error is 17.5 % below the printed one, and is not tuned.
        let published = run["published"].as_array().expect("figures");
        assert!((number(&published[1], "difference_percent") + 17.5).abs() < 0.1);
        assert_eq!(run["digest"], run["cases"]["unbalance"]["digest"]);
        assert!(number(&run["cases"]["friction"], "velocity_error_mps") > 0.0);
    }
}

#[test]
fn paper_torque_steps_leave_the_offsets_of_the_stops() {
    let bench = Bench::new();
    // 2.2e5, 2.5e5 and 3e5 dyne cm kept on leave 0.1346, 1.099 and 5.609 deg; to the last digit given.
    for (torque_nm, offset_deg, digit_deg) in [("0.022", 0.1346, 1e-4), ("0.025", 1.099, 1e-3), ("0.03", 5.609, 1e-3)] {
        for system in [&["--number", "f32"][..], &["--number", "fixed"], &["--plant"]] {
            let arguments = [&["run", "--json", "--disturbance-nm", torque_nm], system].concat();
            let run = bench.json(&arguments);
            let found_deg = number(&run, "residual_offset_rad") / DEGREE_RAD;
            assert!((found_deg - offset_deg).abs() < digit_deg, "{arguments:?}: {found_deg}");
        }
    }
    // Contact at 61.0 ms and release at 422.3 ms for 3e5 dyne cm.
    let run = bench.json(&["run", "--json", "--disturbance-nm", "0.03"]);
    assert!((number(&run, "time_on_stop_s") - 0.3613).abs() < 2e-4, "{run}");
    assert_eq!(run["faults"].as_array().expect("names").len(), 2);
    let run = bench.json(&["run", "--json", "--disturbance-nm", "0.01,2"]);
    assert!(number(&run, "time_on_stop_s").abs() < 1e-12);
    assert!((number(&run, "peak_gyro_angle_rad") / DEGREE_RAD - 0.244).abs() < 1e-3);
}

#[test]
fn cross_flight_law_agrees_with_the_reference_plant_on_a_log() {
    let bench = Bench::new();
    bench.write("log.csv", swaying(5000, 1000.0));
    let law = bench.json(&["run", "log.csv", "--json"]);
    let plant = bench.json(&["run", "log.csv", "--json", "--plant"]);
    assert_eq!((&law["samples"], &plant["number"]), (&plant["samples"], &"plant".into()));
    for key in ["peak_gimbal_angle_rad", "peak_gyro_angle_rad", "velocity_error_mps", "position_error_m"] {
        let (law, plant) = (number(&law, key), number(&plant, key));
        // The law takes the mean over a period, the plant the line: they differ by (w T)^2 / 12, 2 % at the loop's
        // 500 rad/s, of the fast part of a reversal, which is below a twentieth of the peak.
        assert!((law - plant).abs() < 1e-3 * plant.abs(), "{key}: {law} against {plant}");
    }
}

#[test]
fn closed_form_a_settled_start_moves_nothing_under_a_steady_load() {
    let bench = Bench::new();
    let mut log = format!("{}\n", program::HEADER);
    for k in 0..1000 {
        let _ = writeln!(log, "{},0,50,9.8,0.1", f64::from(k) / 1000.0);
    }
    bench.write("log.csv", log);
    for system in [&["--number", "f32"][..], &["--number", "fixed"], &["--plant"]] {
        let peak_rad = |initial: &str| {
            let run = bench.json(&[&["run", "log.csv", "--json", "--initial", initial], system].concat());
            number(&run, "peak_gimbal_angle_rad")
        };
        // The motor carries the load from the start; what is left is rounding, of f32 at the most.
        assert!(peak_rad("settled") < 1e-6 * peak_rad("zero"), "{system:?}");
    }
}

#[test]
fn closed_form_the_plant_takes_the_cross_rate_through_its_coupling_alone() {
    let bench = Bench::new();
    let log = |title: &str, cross: &str| {
        let rows = (0..1000).map(|k| format!("{},0,50,9.8,0.1{cross}\n", f64::from(k) / 1000.0));
        format!("{}{title}\n{}", program::HEADER, rows.collect::<String>())
    };
    bench.write("log.csv", log(",cross_rate_radps", ",0.25"));
    bench.write("without.csv", log("", ""));
    // 4e-2 kg m2 * 0.1 rad/s * 0.25 rad/s = 1e-3 N m
    bench.write("coupled.toml", "[effects]\ncross_axis_coupling = { coefficient_kg_m2 = 4e-2 }\n");
    bench.write("pushed.toml", "[effects]\nconstant_torque = { torque_nm = 1e-3 }\n");
    let run = |log: &str, model: &str, system: &[&str]| {
        bench.json(&[&["run", log, "--json", "--model", model], system].concat())
    };
    let (coupled, pushed) = (run("log.csv", "coupled.toml", &["--plant"]), run("log.csv", "pushed.toml", &["--plant"]));
    let peak_rad = |run| number(run, "peak_gimbal_angle_rad");
    assert!((peak_rad(&coupled) / peak_rad(&pushed) - 1.0).abs() < 1e-9, "{coupled} {pushed}");
    assert!(!coupled["notes"].to_string().contains("cross"), "{coupled}");
    // what does not act is told
    let nothing = run("without.csv", "coupled.toml", &["--plant"]);
    assert!((peak_rad(&nothing) / peak_rad(&pushed) - 1.0).abs() > 1e-3);
    assert!(nothing["notes"].to_string().contains("the log has no `cross_rate_radps`"), "{nothing}");
    assert!(pushed["notes"].to_string().contains("`cross_rate_radps` is not used"), "{pushed}");
    let law = run("log.csv", "coupled.toml", &[]);
    assert!(law["notes"].to_string().contains("the flight law leaves out cross_axis_coupling"), "{law}");
}

#[test]
fn contract_the_main_job_needs_no_argument() {
    let bench = Bench::new();
    let text = bench.succeed(&[]);
    assert_eq!(text, bench.succeed(&["run"]));
    assert!(text.contains("paper, velocity error") && text.contains("open"), "{text}");
}

#[test]
fn contract_a_run_of_its_own_output_gives_the_same_digest() {
    let bench = Bench::new();
    bench.write("log.csv", swaying(3000, 1000.0));
    let first = bench.json(&["run", "log.csv", "--json", "--out", "out.csv", "--plot", "out.svg"]);
    let again = bench.json(&["run", "out.csv", "--json"]);
    assert_eq!(first["digest"], again["digest"]);
    let written = bench.read("out.csv");
    let header = written.lines().next().expect("a header");
    assert!(header.contains("gimbal_angle_rad") && header.ends_with(",note"), "{header}");
    assert!(written.lines().nth(2001).expect("a row").ends_with(",n2000"));
    assert_eq!(written.lines().count(), 3001);
    let picture = bench.read("out.svg");
    assert!(picture.starts_with("<svg") && picture.contains("Velocity error [") && picture.contains("time [s]"));
    assert_eq!(bench.files(), ["log.csv", "out.csv", "out.svg"]);
}

#[test]
fn contract_measured_columns_stand_beside_the_computed_ones() {
    let bench = Bench::new();
    let log = swaying(10, 1000.0).replace("note", "gyro_angle_rad").replace(",n", ",0.00");
    bench.write("log.csv", log);
    bench.succeed(&["run", "log.csv", "--out", "out.csv"]);
    let written = bench.read("out.csv");
    assert!(written.lines().next().expect("a header").ends_with(",logged_gyro_angle_rad"), "{written}");
}

#[test]
fn contract_gaps_repeats_and_missing_samples_are_mended_and_told() {
    let bench = Bench::new();
    let whole = swaying(2000, 1000.0);
    let mut lines: Vec<String> = whole.lines().map(str::to_owned).collect();
    lines.drain(501..504);
    lines.insert(100, lines[100].clone());
    let cells: Vec<&str> = lines[300].split(',').collect();
    lines[300] = format!("{},,{},{},{},{}", cells[0], cells[2], cells[3], cells[4], cells[5]);
    bench.write("log.csv", lines.join("\n"));
    let run = bench.json(&["run", "log.csv", "--json"]);
    assert_eq!(run["samples"], 2000);
    let notes = run["notes"].to_string();
    assert!(notes.contains("1 gap (3 samples), the longest 0.0040 s after 0.499 s"), "{notes}");
    assert!(notes.contains("1 repeated time stamp"), "{notes}");
    assert!(notes.contains("3 missing rows: filled in along straight lines"), "{notes}");
    assert!(notes.contains("1 row less than half a period behind another: left out"), "{notes}");
    assert!(notes.contains("1 missing sample: taken as the last one known"), "{notes}");
    bench.write("whole.csv", whole);
    let exact = bench.json(&["run", "whole.csv", "--json"]);
    let (mended, exact) = (number(&run, "velocity_error_mps"), number(&exact, "velocity_error_mps"));
    assert!((mended - exact).abs() < 1e-3 * exact, "{mended} {exact}");
}
