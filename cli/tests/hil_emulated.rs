//! The emulated board: the same bits as the host over every scenario, and what happens when the emulator dies.
//!
//! The images are those of `GIMBAL_HIL_IMAGES`, which `cargo xtask test` (stage `target-hil`) sets.

#![cfg(unix)]

mod program;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use gimbal_bench::record::Record;
use gimbal_bench::scenario::SHIPPED;
use program::{Bench, number};

/// An image, or a visible line and nothing.
fn image(name: &str) -> Option<String> {
    let Some(folder) = std::env::var_os("GIMBAL_HIL_IMAGES") else {
        println!("SKIPPED: GIMBAL_HIL_IMAGES is not set; `cargo xtask test --only target-hil` sets it");
        return None;
    };
    let path: PathBuf = Path::new(&folder).join(name);
    assert!(path.exists(), "{}", path.display());
    Some(path.to_string_lossy().into_owned())
}

#[test]
fn contract_the_board_says_what_the_host_says_over_every_scenario() {
    let Some(image) = image("hil_fifo") else { return };
    let bench = Bench::new();
    let reports = bench.json(&["hil", "all", "--image", &image, "--json", "--record", "records"]);
    let (mut simulated_s, mut elapsed_s) = (0.0, 0.0);
    for (report, shipped) in reports.as_array().expect("a list").iter().zip(SHIPPED) {
        assert_eq!((&report["scenario"], &report["verdict"]), (&shipped.name.into(), &"pass".into()), "{report:#}");
        assert_eq!((&report["host_equals_board"], &report["link"]["asked_again"]), (&true.into(), &0.into()));
        let deadlines = &report["deadlines"];
        simulated_s += number(deadlines, "ticks") * number(deadlines, "period_s");
        elapsed_s += number(deadlines, "elapsed_s");
    }
    println!("{simulated_s} s in {elapsed_s:.1} s, {:.1} x real time", simulated_s / elapsed_s);
    // Recorded in process, run again on the board, and the other way round.
    bench.succeed(&["hil", "link-noise", "--target", "host", "--record", "host.rec"]);
    assert!(std::fs::read(bench.path("host.rec")).ok() == std::fs::read(bench.path("records/link-noise.rec")).ok());
    let again = bench.json(&["hil", "replay", "records/disconnect.rec", "--image", &image, "--json"]);
    assert_eq!(again["identical"], true, "{again}");
}

#[test]
fn contract_the_serial_port_says_the_same() {
    let Some(image) = image("hil") else { return };
    let bench = Bench::new();
    let arguments = ["hil", "rocket", "--transport", "uart", "--image", &image, "--duration-s", "1.5", "--json"];
    let output = bench.run(&arguments);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["host_equals_board"], true, "{report:#}");
    println!(
        "{:.0} exchanges a second",
        number(&report["deadlines"], "ticks") / number(&report["deadlines"], "elapsed_s")
    );
}

#[test]
fn contract_a_killed_emulator_leaves_a_partial_record_and_report() {
    let Some(image) = image("hil_fifo") else { return };
    let bench = Bench::new();
    let arguments =
        ["hil", "sway", "--duration-s", "600", "--image", &image, "--realtime", "--record", "run.rec", "--out", "out"];
    let program = bench.command(&arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("runs");
    let part = bench.path("run.rec.part");
    let begun = Instant::now();
    while std::fs::metadata(&part).map_or(0, |data| data.len()) < 100_000 && begun.elapsed() < Duration::from_mins(1) {
        std::thread::sleep(Duration::from_millis(20));
    }
    // The emulator is the bench's only child.
    let children = Command::new("pgrep").args(["-P", &program.id().to_string()]).output().expect("pgrep runs");
    let emulator = String::from_utf8_lossy(&children.stdout).trim().to_owned();
    assert!(Command::new("kill").args(["-KILL", &emulator]).status().expect("kill runs").success());
    let output = program.wait_with_output().expect("ended");
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(told.contains("the emulator has ended"), "{told}");
    let report: serde_json::Value = serde_json::from_str(&bench.read("out/hil.json")).expect("JSON");
    assert_eq!(report["verdict"], "aborted");
    let record = Record::open(&bench.path("run.rec")).expect("a record");
    assert!(record.cut.is_some() && record.entries.len() > 100);
    // A second start works at once.
    bench.json(&["hil", "rocket", "--duration-s", "1", "--image", &image, "--json"]);
}
