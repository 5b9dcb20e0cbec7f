//! Chooses the board, gives the linker its memory map and the programs their constants; prepares what the program `flight`
//! flies with, so that the target needs no doubles for it, and images of the laws with effects.
//!
//! The board is `GIMBAL_BOARD`, or the default one of the target. A linker looks for `memory.x` in its working
//! directory first, which is the root of the workspace, so the default board's map would shadow every other: only the
//! default board is linked through `memory.x`; for the others the map is written into the link script itself.

#[path = "build/corrected.rs"]
mod corrected;
#[path = "build/minute.rs"]
mod minute;

use serde::Deserialize;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

#[derive(Deserialize)]
struct Board {
    target: String,
    #[serde(default)]
    default: bool,
    flash: Region,
    ram: Region,
    counter: Counter,
    watchdog: Option<Peripheral>,
    uart: Option<Peripheral>,
    clint: Option<Clint>,
    sensor: Option<Sensor>,
}

#[derive(Deserialize)]
struct Clint {
    address: u32,
    hz: u32,
}

#[derive(Deserialize)]
struct Sensor {
    address: u32,
    interrupt: u16,
}

#[derive(Deserialize)]
struct Peripheral {
    address: u32,
}

#[derive(Deserialize)]
struct Region {
    origin: u32,
    length_bytes: u32,
}

#[derive(Deserialize)]
struct Counter {
    hz: u32,
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=boards");
    println!("cargo:rerun-if-changed=../memory.x");
    println!("cargo:rerun-if-changed=vectors");
    for source in ["build", "build.rs", "src/effects.rs", "src/noise.rs", "src/profile.rs"] {
        println!("cargo:rerun-if-changed={source}");
    }
    println!("cargo:rerun-if-env-changed=GIMBAL_BOARD");
    let out = PathBuf::from(env::var("OUT_DIR")?);
    minute::write(&out, &write_vectors(&out)?)?;
    corrected::write(&out)?;
    if env::var("CARGO_CFG_TARGET_OS")? != "none" {
        return write_constants(&out, "host", 1_000_000, [None; 2], (None, None), u32::MAX);
    }
    let target = env::var("TARGET")?;
    let (name, board) = choose(&target)?;
    let peripherals = [board.watchdog.as_ref(), board.uart.as_ref()];
    write_constants(
        &out,
        &name,
        board.counter.hz,
        peripherals,
        (board.sensor.as_ref(), board.clint.as_ref()),
        board.ram.length_bytes,
    )?;
    link(&out, &target, &board)
}

/// The board that was asked for, or the target's only or default one.
fn choose(target: &str) -> Result<(String, Board), Box<dyn Error>> {
    let asked = env::var("GIMBAL_BOARD").ok();
    let mut found = Vec::new();
    for entry in fs::read_dir("boards")? {
        let path = entry?.path();
        let name = path.file_stem().ok_or("a board without a name")?.to_string_lossy().into_owned();
        let board: Board =
            toml::from_str(&fs::read_to_string(&path)?).map_err(|e| format!("{}: {e}", path.display()))?;
        if board.target == target && asked.as_ref().is_none_or(|asked| *asked == name) {
            found.push((name, board));
        }
    }
    if found.len() > 1 {
        found.retain(|(_, board)| board.default);
    }
    found.pop().ok_or_else(|| format!("firmware/boards/ has no board {asked:?} for {target}; set GIMBAL_BOARD").into())
}

fn write_constants(
    out: &Path,
    name: &str,
    counter_hz: u32,
    peripherals: [Option<&Peripheral>; 2],
    (sensor, clint): (Option<&Sensor>, Option<&Clint>),
    ram_bytes: u32,
) -> Result<(), Box<dyn Error>> {
    let ram_bytes = thousands(ram_bytes);
    let counter_hz = thousands(counter_hz);
    let sensor = sensor
        .map_or("None".into(), |Sensor { address, interrupt }| format!("Some(({}, {interrupt}))", grouped(*address)));
    let clint = clint
        .map_or("None".into(), |Clint { address, hz }| format!("Some(({}, {}))", grouped(*address), thousands(*hz)));
    let [watchdog, uart] = peripherals.map(|peripheral| {
        peripheral.map_or("None".into(), |peripheral| format!("Some({})", grouped(peripheral.address)))
    });
    let text = format!(
        "/// Name of the board: its file in `boards/`.\npub const NAME: &str = \"{name}\";\n\
         /// Rate of the instruction counter in virtual time [1/s].\npub const COUNTER_HZ: u32 = {counter_hz};\n\
         /// Base address of the CMSDK watchdog, if the board has one.\npub const WATCHDOG: Option<u32> = {watchdog};\n\
         /// Base address of the CMSDK UART, if the board has one.\npub const UART: Option<u32> = {uart};\n\
         /// Base address and interrupt of the PL022 port that the sensor sits on, if the board has one.\n\
         pub const SENSOR: Option<(u32, u16)> = {sensor};\n\
         /// Base address of the core-local interruptor of a RISC-V board, and the rate of its timer [1/s].\n\
         pub const CLINT: Option<(u32, u32)> = {clint};\n\
         /// Memory for data and stack [bytes].\npub const RAM_BYTES: u32 = {ram_bytes};\n"
    );
    Ok(fs::write(out.join("board.rs"), text)?)
}

/// A number as it is written by hand.
fn thousands(number: u32) -> String {
    if number < 1_000 { number.to_string() } else { format!("{}_{:03}", thousands(number / 1_000), number % 1_000) }
}

/// An address as it is written by hand.
fn grouped(address: u32) -> String {
    format!("{:#06x}_{:04x}", address >> 16, address & 0xFFFF)
}

/// The committed flight as an array: the boards have no files.
fn write_vectors(out: &Path) -> Result<Vec<[i16; 4]>, Box<dyn Error>> {
    let text = fs::read_to_string("vectors/flight.csv")?;
    let mut rows = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let cells = line.split(',').map(str::parse).collect::<Result<Vec<i16>, _>>()?;
        rows.push(<[i16; 4]>::try_from(cells).map_err(|_| format!("vectors/flight.csv: `{line}` has not four cells"))?);
    }
    fs::write(out.join("flight.rs"), format!("{rows:?}"))?;
    Ok(rows)
}

/// Link arguments for every program of this package.
fn link(out: &Path, target: &str, board: &Board) -> Result<(), Box<dyn Error>> {
    if board.default {
        println!("cargo:rustc-link-arg=-Tlink.x");
    } else if target.starts_with("thumb") {
        let template = fs::read_to_string(runtime_script(out)?)?;
        if template.matches("INCLUDE memory.x").count() != 1 {
            return Err("cortex-m-rt's link.x no longer includes memory.x once".into());
        }
        let path = out.join("board-link.x");
        fs::write(&path, template.replace("INCLUDE memory.x", &memory(board)))?;
        println!("cargo:rustc-link-arg=-T{}", path.display());
    } else {
        let path = out.join("board-memory.x");
        fs::write(&path, memory(board) + RISCV_REGIONS)?;
        println!("cargo:rustc-link-arg=-T{}", path.display());
        println!("cargo:rustc-link-arg=-Tlink.x");
    }
    if env::var_os("CARGO_FEATURE_DEFMT").is_some() {
        println!("cargo:rustc-link-arg-bin=flight=-Tdefmt.x");
        // Unless told otherwise defmt leaves out all but errors.
        println!("cargo:rustc-env=DEFMT_LOG=info");
    }
    // Sections need not start on a page of the host.
    println!("cargo:rustc-link-arg=--nmagic");
    Ok(())
}

fn memory(board: &Board) -> String {
    let region = |r: &Region| format!("ORIGIN = {:#010x}, LENGTH = {:#x}", r.origin, r.length_bytes);
    format!("MEMORY\n{{\n  FLASH : {}\n  RAM   : {}\n}}\n", region(&board.flash), region(&board.ram))
}

const RISCV_REGIONS: &str = "\
REGION_ALIAS(\"REGION_TEXT\", FLASH);
REGION_ALIAS(\"REGION_RODATA\", FLASH);
REGION_ALIAS(\"REGION_DATA\", RAM);
REGION_ALIAS(\"REGION_BSS\", RAM);
REGION_ALIAS(\"REGION_HEAP\", RAM);
REGION_ALIAS(\"REGION_STACK\", RAM);
";

/// The newest `link.x` that cortex-m-rt's build script wrote. It ran before this one (it declares `links`), and its
/// folder lies beside ours; cargo passes its path to the linker only.
fn runtime_script(out: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let builds = out.ancestors().find(|folder| folder.ends_with("build")).ok_or("OUT_DIR lies in no build folder")?;
    let mut scripts = Vec::new();
    for entry in fs::read_dir(builds)? {
        let folder = entry?.path();
        if folder.file_name().is_some_and(|name| name.to_string_lossy().starts_with("cortex-m-rt")) {
            collect(&folder, &mut scripts)?;
        }
    }
    scripts.sort_by_key(|path| path.metadata().and_then(|data| data.modified()).ok());
    scripts.pop().ok_or_else(|| format!("no link.x of cortex-m-rt below {}", builds.display()).into())
}

fn collect(folder: &Path, scripts: &mut Vec<PathBuf>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, scripts)?;
        } else if path.ends_with("link.x") {
            scripts.push(path);
        }
    }
    Ok(())
}
