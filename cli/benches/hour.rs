//! One hour of samples: the step alone, and the whole command beside a bare parse of the same file.
//!
//! `cargo bench -p gimbal-cli --bench hour` prints the table of `docs/benchmarks.md`. Each figure is the median of
//! interleaved runs; ratios are taken run by run, so that a machine whose speed drifts does not distort them.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use gimbal_servo::{Config, Fixed, Input, Number};

const ROWS: u32 = 3_600_000;
const RUNS: usize = 5;

/// A manoeuvre that never repeats within the hour: three slow oscillations of unrelated periods.
fn row(index: u32) -> Input<f64> {
    let time = f64::from(index) * 1e-3;
    Input {
        accel_x_mps2: 9.0 * (0.31 * time).sin(),
        accel_y_mps2: 40.0 + 30.0 * (0.17 * time).sin(),
        accel_z_mps2: 9.81 + 4.0 * (0.7 * time).cos(),
        vehicle_rate_radps: 0.3 * (0.53 * time).sin(),
        ..Input::default()
    }
}

fn main() -> std::io::Result<()> {
    let folder = tempfile::tempdir()?;
    let log = folder.path().join("hour.csv");
    write_log(&log)?;
    let megabytes = log.metadata()?.len() as f64 / 1e6;

    let (mut parse, mut command, mut float, mut fixed) = ([0.0; RUNS], [0.0; RUNS], [0.0; RUNS], [0.0; RUNS]);
    for run in 0..RUNS {
        parse[run] = seconds(|| bare_parse(&log));
        command[run] = seconds(|| gimbal_run(&log));
        float[run] = stepping::<f32>();
        fixed[run] = stepping::<Fixed>();
        eprintln!("run {} of {RUNS}", run + 1);
    }
    let ratio: Vec<f64> = command.iter().zip(&parse).map(|(command, parse)| command / parse).collect();
    println!("1 h of samples at 1 kHz, {ROWS} rows; the file has {megabytes:.0} MB. Median of {RUNS} runs.\n");
    println!("| what | seconds | ratio to the bare parse | times real time |");
    println!("|---|---|---|---|");
    let line = |what: &str, seconds: f64, ratio: &str| {
        println!("| {what} | {seconds:.3} | {ratio} | {:.0} |", 3600.0 / seconds);
    };
    line("bare parse: `csv::ByteRecord`, no number read", median(&parse), "1");
    line("`gimbal run hour.csv`, whole command", median(&command), &format!("{:.2}", median(&ratio)));
    line("step, f32", median(&float), "");
    line("step, fixed", median(&fixed), "");
    Ok(())
}

fn write_log(path: &Path) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(file, "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps")?;
    for index in 0..ROWS {
        let Input { accel_x_mps2: x, accel_y_mps2: y, accel_z_mps2: z, vehicle_rate_radps: rate, .. } = row(index);
        writeln!(file, "{:.3},{x:.5},{y:.5},{z:.5},{rate:.6}", f64::from(index) * 1e-3)?;
    }
    file.flush()
}

fn seconds(mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn bare_parse(log: &Path) {
    let mut reader = csv::Reader::from_path(log).expect("the log was just written");
    let mut record = csv::ByteRecord::new();
    let mut rows = 0;
    while reader.read_byte_record(&mut record).expect("the log was just written") {
        rows += 1;
    }
    assert_eq!(rows, ROWS);
}

fn gimbal_run(log: &Path) {
    let status = Command::new(env!("CARGO_BIN_EXE_gimbal"))
        .arg("run")
        .arg(log)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .expect("the command starts");
    assert!(status.success());
}

/// Seconds of all steps, without the making of their inputs.
fn stepping<N: Number>() -> f64 {
    let law = Config::consistent().build::<N>().expect("a preset");
    let inputs: Vec<Input<N>> = (0..ROWS).map(|index| law.units().input(&row(index))).collect();
    let mut state = law.start();
    let time = seconds(|| {
        for input in &inputs {
            std::hint::black_box(law.step(&mut state, *input));
        }
    });
    std::hint::black_box(law.velocity_error_mps(&state));
    time
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}
