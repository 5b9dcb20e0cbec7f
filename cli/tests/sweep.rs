//! `gimbal sweep`: answers, threads, interruptions, wrong calls.

mod program;

use std::process::Stdio;
use std::time::{Duration, Instant};

use program::{Bench, number};

/// More than two of the blocks in which runs are written.
const RUNS: &str = "80";

#[test]
fn contract_a_killed_sweep_goes_on_to_the_same_bytes_with_any_number_of_threads() {
    let bench = Bench::new();
    let whole = ["sweep", "--monte-carlo", RUNS, "--threads", "1", "--out", "whole.csv"];
    bench.succeed(&whole);
    let killed = ["sweep", "--monte-carlo", RUNS, "--threads", "2", "--out", "killed.csv"];
    let mut child = bench.command(&killed).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    let partial =
        || bench.files().into_iter().find(|name| name.starts_with("killed.csv.") && name.ends_with(".partial"));
    let started = Instant::now();
    let rows = loop {
        let rows = partial().map_or(0, |name| bench.read(&name).lines().count());
        if rows > 2 || started.elapsed() > Duration::from_mins(2) {
            break rows;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    assert!(rows > 2 && !bench.path("killed.csv").exists(), "{rows} rows; too fast to be killed?");
    // A torn row and one out of place, as a power cut leaves them.
    let name = partial().expect("the rows so far");
    let torn = format!("{}5,not-a-row", bench.read(&name));
    bench.write(&name, torn);
    bench.succeed(&killed);
    assert_eq!(bench.read("killed.csv"), bench.read("whole.csv"));
    assert!(partial().is_none());
}

#[test]
fn closed_form_the_limit_follows_the_stop_and_the_unbalance() {
    let bench = Bench::new();
    let grid = ["sweep", "--case", "unbalance", "--vary", "stop=0.006..0.008:3", "--vary", "u=1e-4..1.2e-4:2"];
    bench.succeed(&[&grid[..], &["--out", "grid.csv", "--plot", "grid.svg"]].concat());
    let text = bench.read("grid.csv");
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), 6);
    // theta is proportional to the unbalance torque: limit u / stop is the same everywhere. f32: 1e-6, root: 2e-6.
    let constant = |row: &[f64]| row[3] * row[2] / row[1];
    assert!(rows.iter().all(|row| (constant(row) / constant(&rows[0]) - 1.0).abs() < 1e-5), "{text}");
    assert!(bench.read("grid.svg").starts_with("<svg"));
}

#[test]
fn regress_the_nominal_platform_saturates_where_the_paper_ends() {
    let bench = Bench::new();
    for (case, limit_g) in [("unbalance", 20.88), ("friction", 31.09), ("both", 15.70)] {
        let answer = bench.json(&["sweep", "--case", case, "--monte-carlo", "2", "--json"]);
        let found_g = number(&answer["metrics"]["saturation_g"], "nominal");
        assert!((found_g - limit_g).abs() < 0.01, "{case}: {found_g}");
    }
}

#[test]
fn contract_latin_hypercubes_fill_every_stratum_once() {
    let bench = Bench::new();
    bench.succeed(&[
        "sweep",
        "--case",
        "unbalance",
        "--vary",
        "K=8..9",
        "--vary",
        "T5=0.1..0.2",
        "--latin",
        "10",
        "--out",
        "l.csv",
    ]);
    let text = bench.read("l.csv");
    for (column, from, width) in [(1, 8.0, 1.0), (2, 0.1, 0.1)] {
        let mut strata: Vec<String> = text
            .lines()
            .skip(1)
            .map(|row| row.split(',').nth(column).and_then(|cell| cell.parse::<f64>().ok()).expect("a number"))
            .map(|value| format!("{:.0}", (10.0 * (value - from) / width).floor()))
            .collect();
        strata.sort();
        assert!(strata.iter().map(String::as_str).eq(["0", "1", "2", "3", "4", "5", "6", "7", "8", "9"]), "{strata:?}");
    }
}

#[test]
fn contract_wrong_calls_are_told() {
    let bench = Bench::new();
    assert!(bench.fail(2, &["sweep", "--vary", "gain=7..9"]).contains("servo.gain_nm_per_rad_s"));
    assert!(bench.fail(2, &["sweep", "--accel-g", "80"]).contains("50.0 g"));
    assert!(bench.fail(2, &["sweep", "--monte-carlo", "0"]).contains("runs"));
    bench.fail(2, &["sweep", "--latin", "10"]);
}
