//! `gimbal doctor`: what hardware in the loop needs and this machine lacks, each with the command that mends it.

use std::path::Path;
use std::process::Command;

use clap::Parser;
use gimbal_bench::emulator;
use gimbal_bench::link::{PROGRAM_BAUD, Serial, least_baud};
use serde_json::json;

use crate::exit::Failure;
use crate::report;

/// What is missing on this machine, and how to mend it.
#[derive(Debug, Parser)]
pub(crate) struct Args {
    /// A serial port to look at
    #[arg(long, value_name = "DEVICE")]
    port: Option<String>,
    /// Its baud rate, if it is to fly in real time
    #[arg(long, value_name = "N", requires = "port")]
    baud: Option<u32>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// One thing looked at.
struct Finding {
    name: &'static str,
    state: Result<String, (String, String)>,
}

/// Looks, and tells.
pub(crate) fn doctor(args: &Args) -> Result<(), Failure> {
    let mut findings = vec![
        Finding { name: "emulator", state: emulator_state() },
        Finding { name: "source", state: source() },
        Finding { name: "compiler", state: compiler() },
    ];
    if let Some(port) = &args.port {
        findings.push(Finding { name: "baud rate", state: baud(args.baud) });
        findings.push(Finding { name: "port", state: port_state(port, args.baud.unwrap_or(PROGRAM_BAUD)) });
    }
    let lines: Vec<String> = findings
        .iter()
        .map(|finding| match &finding.state {
            Ok(told) => format!("ok       {:<10} {told}", finding.name),
            Err((what, mend)) => format!("MISSING  {:<10} {what}\n                    mend: {mend}", finding.name),
        })
        .collect();
    let list: Vec<_> = findings
        .iter()
        .map(|finding| match &finding.state {
            Ok(told) => json!({ "name": finding.name, "ok": true, "found": told }),
            Err((what, mend)) => json!({ "name": finding.name, "ok": false, "found": what, "mend": mend }),
        })
        .collect();
    report::print(&lines.join("\n"), args.json.then(|| json!({ "findings": list })).as_ref())?;
    let missing = findings.iter().filter(|finding| finding.state.is_err()).count();
    if missing == 0 {
        return Ok(());
    }
    Err(Failure::Environment(anyhow::anyhow!(
        "{missing} of {} not ready; `--target host` needs none of them",
        findings.len()
    )))
}

type State = Result<String, (String, String)>;

fn missing(what: impl Into<String>, mend: impl Into<String>) -> State {
    Err((what.into(), mend.into()))
}

fn emulator_state() -> State {
    match emulator::version() {
        Some(version) => Ok(version),
        None => missing(format!("{} does not start", emulator::PROGRAM), "sudo apt-get install qemu-system-arm"),
    }
}

fn source() -> State {
    match emulator::workspace() {
        Some(folder) => Ok(format!("firmware in {}", folder.display())),
        None => missing(
            "the firmware's source is not here",
            "run in the project's folder, or give `gimbal hil --image FILE`",
        ),
    }
}

fn compiler() -> State {
    let target = emulator::TARGET;
    let output = Command::new("rustc").args(["--print", "sysroot"]).output();
    let Ok(output) = output else { return missing("rustc does not start", "install Rust from https://rustup.rs") };
    let sysroot = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    if Path::new(&sysroot).join("lib/rustlib").join(target).join("lib").exists() {
        return Ok(format!("{target} in {sysroot}"));
    }
    let mend = format!("rustup target add {target}; on a closed network: cargo xtask test --only target-setup");
    missing(format!("no core library for {target}"), mend)
}

fn baud(baud: Option<u32>) -> State {
    let least = least_baud(1e-3);
    let Some(baud) = baud else {
        return Ok(format!("{PROGRAM_BAUD}, that of the program `hil`, for lockstep; real time takes {least} or more"));
    };
    if baud >= least {
        return Ok(format!("{baud}; one exchange a millisecond takes {least}"));
    }
    missing(
        format!("{baud} is too slow for real time at 1 kHz"),
        format!("--baud {least} or more; lockstep works at any rate"),
    )
}

fn port_state(path: &str, baud: u32) -> State {
    if !Path::new(path).exists() {
        let known = ports();
        let there =
            if known.is_empty() { "there is none".to_owned() } else { format!("there is {}", known.join(", ")) };
        return missing(
            format!("{path}: no such port; {there}"),
            "plug the board in, or `sudo dmesg | tail` to see its name",
        );
    }
    if let Some((process, name)) = holder(Path::new(path)) {
        return missing(format!("{path}: held by {name} (process {process})"), format!("end {name}: kill {process}"));
    }
    match Serial::open(path, baud) {
        Ok(_) => Ok(format!("{path} opens")),
        Err(error) => {
            let mend = if writable(path) {
                "close the program that holds it: `sudo lsof`, then the port's name"
            } else {
                "sudo usermod -aG dialout $USER, and log in anew"
            };
            missing(error.to_string(), mend)
        }
    }
}

fn writable(path: &str) -> bool {
    std::fs::File::options().read(true).write(true).open(path).is_ok()
}

/// Serial ports of this machine.
fn ports() -> Vec<String> {
    let Ok(entries) = std::fs::read_dir("/dev") else { return Vec::new() };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut ports: Vec<String> = names
        .filter(|name| ["ttyACM", "ttyUSB", "tty.usb", "cu.usb"].iter().any(|start| name.starts_with(start)))
        .map(|name| format!("/dev/{name}"))
        .collect();
    ports.sort();
    ports
}

/// Another program that has a file open, where the system tells.
fn holder(path: &Path) -> Option<(u32, String)> {
    let path = path.canonicalize().ok()?;
    let own = std::process::id();
    for entry in std::fs::read_dir("/proc").ok()?.flatten() {
        let Some(process) = entry.file_name().to_str().and_then(|name| name.parse::<u32>().ok()) else { continue };
        let Ok(open) = std::fs::read_dir(entry.path().join("fd")) else { continue };
        let held = open.flatten().any(|file| std::fs::read_link(file.path()).is_ok_and(|target| target == path));
        if held && process != own {
            let name = std::fs::read_to_string(entry.path().join("comm")).unwrap_or_default();
            return Some((process, name.trim().to_owned()));
        }
    }
    None
}
