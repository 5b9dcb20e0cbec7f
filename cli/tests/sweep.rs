//! `gimbal sweep`: answers, threads, interruptions, wrong calls.

#![cfg(unix)]

mod program;

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use program::{Bench, number};

/// More than two of the blocks in which one thread writes them.
const RUNS: &str = "72";

/// The file of a sweep that was ended on the way and called again is that of an uninterrupted one, CSV or Parquet, with any
/// number of threads; Ctrl-C is told by status 130.
#[test]
fn contract_an_ended_sweep_goes_on_to_the_same_bytes() {
    let bench = Bench::new();
    for (signal, extension, status) in [("-KILL", "csv", None), ("-INT", "parquet", Some(130))] {
        let (whole, ended) = (format!("whole.{extension}"), format!("ended{signal}.{extension}"));
        bench.succeed(&["sweep", "--monte-carlo", RUNS, "--threads", "2", "--out", &whole]);
        let call = ["sweep", "--monte-carlo", RUNS, "--threads", "1", "--out", &ended];
        let mut child = bench.command(&call).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
        let partial = || bench.files().into_iter().find(|name| name.starts_with(&ended) && name.ends_with(".partial"));
        let started = Instant::now();
        let rows = loop {
            let rows = partial().map_or(0, |name| bench.read(&name).lines().count());
            if rows > 2 || started.elapsed() > Duration::from_mins(2) {
                break rows;
            }
            std::thread::sleep(Duration::from_millis(5));
        };
        let process = child.id().to_string();
        assert!(Command::new("kill").args([signal, &process]).status().expect("kill runs").success());
        let code = child.wait().expect("it ends").code();
        assert!(rows > 2 && !bench.path(&ended).exists(), "{rows} rows; too fast to be ended?");
        assert_eq!(code, status);
        let name = partial().expect("the rows so far");
        if status.is_none() {
            // A torn row and one out of place, as a power cut leaves them.
            let torn = format!("{}5,not-a-row", bench.read(&name));
            bench.write(&name, torn);
        }
        bench.succeed(&call);
        let bytes = |name: &str| std::fs::read(bench.path(name)).expect("a file");
        assert!(bytes(&ended) == bytes(&whole), "{ended}");
        assert!(partial().is_none());
    }
}

/// Each column of the Parquet file holds what the CSV file's column holds; an empty cell is a null.
#[test]
fn cross_parquet_holds_the_rows_of_the_csv_file() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    let bench = Bench::new();
    // Some loops are unstable, and their cells empty.
    let call = ["sweep", "--case", "unbalance", "--vary", "K=8..40:5", "--vary", "T5=0.1..0.3:2"];
    for out in ["grid.csv", "grid.parquet"] {
        bench.succeed(&[&call[..], &["--out", out]].concat());
    }
    let file = std::fs::File::open(bench.path("grid.parquet")).expect("there");
    let reader = SerializedFileReader::new(file).expect("a Parquet file");
    let rows: Vec<String> = reader
        .get_row_iter(None)
        .expect("rows")
        .map(|row| {
            let row = row.expect("a row");
            let cell = |(index, (_, field)): (usize, (&String, &parquet::record::Field))| match field {
                parquet::record::Field::Null => String::new(),
                parquet::record::Field::Long(run) => run.to_string(),
                parquet::record::Field::Double(value) => format!("{value:.9e}"),
                other => panic!("column {index}: {other}"),
            };
            row.get_column_iter().enumerate().map(cell).collect::<Vec<_>>().join(",")
        })
        .collect();
    let text = bench.read("grid.csv");
    assert!(text.contains(",,") && text.lines().skip(1).eq(rows.iter().map(String::as_str)), "{text}{rows:?}");
}

#[test]
fn contract_the_answer_comes_first() {
    let bench = Bench::new();
    let text = bench.succeed(&["sweep", "--monte-carlo", "32"]);
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("the nominal platform saturates at 15.70 g"), "{text}");
    assert!(lines[1].starts_with("within the tolerances 95 % of platforms saturate between"), "{text}");
    assert!(lines[2].starts_with("the part whose tolerances decide it is the servo: "), "{text}");
    assert!(lines[3].starts_with("the single tolerance that counts most is that of "), "{text}");
    assert!(bench.succeed(&["sweep", "--monte-carlo", "1"]).contains("\n1 run, seed"));
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
    assert!(bench.fail(2, &["sweep", "--out", "runs.txt"]).contains(".csv or .parquet"));
}
