//! Every way in which a run can break: a clear line, a partial record that is valid, a report, the exit status, and a
//! second start that works at once. A killed emulator is in `hil_emulated.rs`.

#![cfg(unix)]

mod program;
mod served;

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use gimbal_bench::record::Record;
use program::Bench;
use served::{Ends, serve};

/// Two seconds that pass.
const SHORT: &str = "about = \"Rest.\"\nduration_s = 2\nprofile = { kind = \"rest\" }\n\
                     [[require]]\nmeasure = \"attitude_error_rms_rad\"\nmost = 1e-4\n";

fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("short.toml", SHORT);
    bench.write("long.toml", SHORT.replace("duration_s = 2", "duration_s = 600"));
    bench
}

/// The report of a run that was broken off, in all three forms.
fn aborted(bench: &Bench) -> serde_json::Value {
    let report: serde_json::Value = serde_json::from_str(&bench.read("out/hil.json")).expect("JSON");
    assert_eq!(report["verdict"], "aborted");
    assert!(bench.read("out/hil.html").contains("aborted") && bench.read("out/junit.xml").contains("<error"));
    report
}

/// The record of a run that was broken off: whole as far as it goes, and what it holds replays.
fn cut_record(bench: &Bench) -> Record {
    let record = Record::open(&bench.path("run.rec")).expect("a record");
    assert!(record.cut.is_some() && !bench.path("run.rec.part").exists());
    let again = bench.json(&["hil", "replay", "run.rec", "--target", "host", "--json"]);
    assert_eq!((&again["identical"], &again["complete"]), (&true.into(), &false.into()), "{again}");
    record
}

/// Nothing stands in the way of the next run.
fn starts_again(bench: &Bench) {
    bench.succeed(&["hil", "short.toml", "--target", "host", "--record", "run.rec", "--out", "out"]);
    assert_eq!(Record::open(&bench.path("run.rec")).expect("a record").cut, None);
}

/// A run that has recorded something.
fn under_way(bench: &Bench, arguments: &[&str]) -> Child {
    let mut program = bench.command(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("runs");
    let part = bench.path("run.rec.part");
    let begun = Instant::now();
    while std::fs::metadata(&part).map_or(0, |data| data.len()) < 100_000 {
        assert!(begun.elapsed() < Duration::from_mins(1) && program.try_wait().expect("asked").is_none());
        std::thread::sleep(Duration::from_millis(10));
    }
    program
}

fn interrupt(program: &Child) {
    let process = program.id().to_string();
    assert!(Command::new("kill").args(["-INT", &process]).status().expect("kill runs").success());
}

/// Its exit status, and what it has told.
fn ended(program: Child) -> (Option<i32>, String) {
    let output = program.wait_with_output().expect("ended");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn contract_a_pulled_socket_leaves_a_partial_record_and_report() {
    let bench = bench();
    let served = serve(Ends::After(60_000));
    let told =
        bench.run(&["hil", "short.toml", "--connect", &served.address, "--record", "run.rec", "--out", "out"]).stderr;
    let told = String::from_utf8_lossy(&told);
    assert!(told.contains("the other end has closed the link; see that the computer still runs"), "{told}");
    let ticks = aborted(&bench)["deadlines"]["ticks"].as_u64().expect("a count");
    let record = cut_record(&bench);
    assert!(ticks > 100 && record.entries.iter().filter(|entry| entry.kind == b'T').count() as u64 == ticks);
    let served = serve(Ends::After(60_000));
    let status = bench.run(&["hil", "short.toml", "--connect", &served.address]).status;
    assert_eq!(status.code(), Some(3));
    let served = serve(Ends::Never);
    bench.succeed(&["hil", "short.toml", "--connect", &served.address]);
}

#[test]
fn contract_a_silent_computer_is_given_up_after_the_time_that_is_asked_for() {
    let bench = bench();
    let served = serve(Ends::Silent(60_000));
    let begun = Instant::now();
    let arguments = ["hil", "short.toml", "--connect", &served.address, "--patience-s", "1.5", "--record", "run.rec"];
    let output = bench.run(&[arguments.as_slice(), &["--out", "out"]].concat());
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(told.contains("no answer in 1.5 s") && told.contains("--patience-s"), "{told}");
    assert!(begun.elapsed() < Duration::from_secs(20));
    aborted(&bench);
    cut_record(&bench);
    starts_again(&bench);
    assert!(bench.fail(2, &["hil", "--patience-s", "0"]).contains("between 0.1 and 3600"));
}

#[test]
fn contract_an_interrupt_is_heard_while_an_answer_is_waited_for() {
    let bench = bench();
    let served = serve(Ends::Silent(60_000));
    let arguments = ["hil", "short.toml", "--connect", &served.address, "--record", "run.rec", "--out", "out"];
    let program = bench.command(&arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("runs");
    // By then it has fallen silent, or soon will; the patience is half a minute.
    std::thread::sleep(Duration::from_secs(3));
    interrupt(&program);
    let begun = Instant::now();
    let (status, told) = ended(program);
    assert_eq!(status, Some(130), "{told}");
    assert!(begun.elapsed() < Duration::from_secs(10), "{:?}", begun.elapsed());
    aborted(&bench);
    cut_record(&bench);
    starts_again(&bench);
}

#[test]
fn contract_a_device_that_is_full_is_told_and_the_run_reported() {
    let bench = bench();
    let output = bench.run(&["hil", "short.toml", "--target", "host", "--record", "/dev/full", "--out", "out"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3));
    assert!(told.contains("record: cannot be written") && told.contains("free some space"), "{told}");
    aborted(&bench);
    starts_again(&bench);
}

/// The program with no file longer than some blocks of 512 bytes, as on a disk that fills up.
fn limited(bench: &Bench, blocks: u32, arguments: &[&str]) -> std::process::Output {
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let program = env!("CARGO_BIN_EXE_gimbal");
    let mut command = Command::new("sh");
    command.current_dir(bench.path("")).args(["-c", &script, program]).args(arguments);
    command.output().expect("sh runs")
}

#[test]
fn contract_a_disk_that_fills_up_leaves_a_partial_record_and_report() {
    let bench = bench();
    let arguments = ["hil", "rocket", "--target", "host", "--record", "run.rec", "--out", "out"];
    let output = limited(&bench, 1_000, &arguments);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(told.contains("record: cannot be written") && told.contains("free some space"), "{told}");
    let ticks = aborted(&bench)["deadlines"]["ticks"].as_u64().expect("a count");
    let record = cut_record(&bench);
    assert!(ticks > 100 && record.entries.len() > 100);
    assert!(std::fs::metadata(bench.path("run.rec")).expect("there").len() <= 512_000);
    starts_again(&bench);
}

#[test]
fn contract_a_report_that_does_not_fit_is_told_and_leaves_no_half() {
    let bench = bench();
    let output = limited(&bench, 8, &["hil", "short.toml", "--target", "host", "--out", "out"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(told.contains("out/hil.html: cannot be written"), "{told}");
    let files = std::fs::read_dir(bench.path("out")).expect("listed");
    for file in files.map(|file| file.expect("an entry").path()) {
        assert_ne!(file.file_name(), Some("hil.html".as_ref()));
        let whole = file.extension() != Some("json".as_ref())
            || serde_json::from_str::<serde_json::Value>(&std::fs::read_to_string(&file).expect("read")).is_ok();
        assert!(whole, "{}", file.display());
    }
    starts_again(&bench);
}

#[test]
fn contract_an_interrupted_run_leaves_a_partial_record_and_report() {
    let bench = bench();
    let arguments = ["hil", "long.toml", "--target", "host", "--realtime", "--record", "run.rec", "--out", "out"];
    let program = under_way(&bench, &arguments);
    interrupt(&program);
    let (status, told) = ended(program);
    assert_eq!(status, Some(130), "{told}");
    assert!(told.contains("interrupted"), "{told}");
    aborted(&bench);
    assert!(cut_record(&bench).entries.len() > 100);
    starts_again(&bench);
}

/// A board at a serial port: the master's end of a pair of terminals, and the name of the other one. No other process
/// inherits it, as the program would that a test starts.
fn port() -> (std::fs::File, String) {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).expect("a terminal");
    grantpt(&master).expect("granted");
    unlockpt(&master).expect("unlocked");
    let name = ptsname(&master, Vec::new()).expect("a name").into_string().expect("UTF-8");
    (master.into(), name)
}

#[test]
fn contract_an_unplugged_port_leaves_a_partial_record_and_report() {
    let bench = bench();
    let (mut board, name) = port();
    std::thread::spawn(move || {
        let (mut host, mut buffer, mut said) = (gimbal_bench::link::Host::new(), [0; 1024], 0);
        let begun = Instant::now();
        // Then the board is pulled out.
        while said < 60_000 && begun.elapsed() < Duration::from_mins(1) {
            let Ok(count) = board.read(&mut buffer) else {
                // Nobody has opened the other end yet.
                std::thread::sleep(Duration::from_millis(5));
                continue;
            };
            let mut answers = Vec::new();
            host.answer(&buffer[..count], &mut answers);
            said += answers.len();
            board.write_all(&answers).expect("the bench listens");
        }
    });
    let output = bench.run(&["hil", "short.toml", "--port", &name, "--record", "run.rec", "--out", "out"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(told.contains("the port is gone") && told.contains("plug it in again"), "{told}");
    aborted(&bench);
    assert!(cut_record(&bench).entries.len() > 100);
    starts_again(&bench);
}

#[test]
fn contract_doctor_names_the_program_that_holds_a_port() {
    use serialport::{SerialPort, TTYPort};
    let bench = Bench::new();
    let (_master, slave) = TTYPort::pair().expect("a pair of terminals");
    let name = slave.name().expect("a name");
    let found = |arguments: &[&str]| -> serde_json::Value {
        let output = bench.run(&[&["doctor", "--port", &name, "--json"], arguments].concat());
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let finding = |found: &serde_json::Value, name: &str| {
        let all = found["findings"].as_array().expect("a list").clone();
        all.into_iter().find(|finding| finding["name"] == name).expect("a finding")
    };
    // This process holds the other end.
    let held = finding(&found(&[]), "port");
    let own = std::process::id().to_string();
    assert_eq!(held["ok"], false);
    assert!(held["found"].as_str().is_some_and(|text| text.contains("held by") && text.contains(&own)), "{held}");
    assert!(held["mend"].as_str().is_some_and(|mend| mend.contains(&format!("kill {own}"))), "{held}");
    if Path::new("/proc/self/fd").exists() {
        drop(slave);
        assert_eq!(finding(&found(&[]), "port")["ok"], true);
    }
    assert_eq!(finding(&found(&[]), "baud rate")["ok"], true);
    let slow = finding(&found(&["--baud", "115200"]), "baud rate");
    assert_eq!(slow["ok"], false);
    assert!(slow["mend"].as_str().is_some_and(|mend| mend.contains("--baud 1936843 or more")), "{slow}");
}
