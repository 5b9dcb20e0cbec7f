//! Ctrl-C in the middle of a run: status 130, nothing half-written.

#![cfg(unix)]

mod program;

use std::io::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use program::{Bench, swaying};

#[test]
fn contract_an_interrupted_run_leaves_nothing() {
    let bench = Bench::new();
    let pipe = bench.path("log.csv");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let mut program =
        bench.command(&["run", "log.csv", "--out", "out.csv"]).stderr(Stdio::piped()).spawn().expect("runs");
    let mut log = std::fs::File::options().write(true).open(&pipe).expect("opened by the program too");
    log.write_all(swaying(20_000, 1000.0).as_bytes()).expect("taken");

    // The file under way shows that the run has begun.
    let begun = Instant::now();
    while bench.files().len() < 2 && begun.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(bench.files().len(), 2);
    let process = program.id().to_string();
    assert!(Command::new("kill").args(["-INT", &process]).status().expect("kill runs").success());
    std::thread::sleep(Duration::from_millis(100));
    // A write fails when the program is gone already, which is as good.
    let _ = log.write_all(b"20,0,0,0,0,n\n");
    drop(log);
    assert_eq!(program.wait().expect("ended").code(), Some(130));
    assert_eq!(bench.files(), ["log.csv"]);
}
