//! Stage `c-interface`: the header is what `cbindgen` makes of the sources, and a C program built with `arm-none-eabi-gcc`
//! flies ten seconds on the default board with the host's outputs.

use super::{boards, emulator, packages, toolchain::Toolchain};
use crate::shell::{capture, cargo, program, root, target_dir, version_of};
use crate::stages::Note;
use anyhow::{Context, Result, ensure};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const COMPILER: &str = "arm-none-eabi-gcc";
const HEADER: &str = "c/include/gimbal_servo.h";

/// The default board's core, and the strictness that others' builds may have.
const FLAGS: &str = "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -std=c11 -ffreestanding -O2 \
    -ffp-contract=off -Wall -Wextra -Wconversion -Werror";

pub(crate) fn check() -> Result<Note> {
    let committed = fs::read_to_string(root().join(HEADER)).unwrap_or_default();
    ensure!(committed == header()?, "{HEADER} is not what the sources give; `cargo xtask header` writes it");
    let expected = capture(&mut cargo("run --quiet --release --package gimbal-firmware --example tick_bare"))?;
    let board = boards::by_name(boards::DEFAULT)?;
    let shift = board.emulator.flight_shift.context("the default board flies")?;
    let (output, success) = emulator::run_to_end(&board, &build(&board.target)?, shift)?;
    let (refused, flown) = output.split_once('\n').unwrap_or_default();
    ensure!(success && flown == expected, "the C program:\n{output}host:\n{expected}");
    ensure!(refused.contains("`servo.motor_lag_s` is -1"), "a wrong field is not named:\n{output}");
    print!("{output}");
    Ok("header as committed; the C program's outputs equal the host's, f32 and fixed".into())
}

/// Writes the header.
pub(crate) fn write_header() -> Result<()> {
    let path = root().join(HEADER);
    fs::write(&path, header()?)?;
    eprintln!("wrote {}", path.display());
    Ok(())
}

fn header() -> Result<String> {
    let folder = root().join("c");
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).map_err(anyhow::Error::msg)?;
    let bindings = cbindgen::Builder::new().with_crate(&folder).with_config(config).generate()?;
    let mut text = Vec::new();
    bindings.write(&mut text);
    Ok(String::from_utf8(text)?)
}

/// The library by cargo, the program by gcc.
fn build(target: &str) -> Result<PathBuf> {
    if version_of(COMPILER).is_none() {
        packages::install(&["gcc-arm-none-eabi"], COMPILER)?;
    }
    let toolchain = Toolchain::ready(target)?;
    capture(&mut toolchain.cargo("build --quiet --release --package gimbal-servo-c", target))?;
    let library = toolchain.target_dir().join(target).join("release/libgimbal_servo_c.a");
    let folder = target_dir().join("c");
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("flight_rows.h"), rows(&root().join("firmware/vectors/flight.csv"))?)?;
    let image = folder.join("flight");
    let example = root().join("c/example");
    let mut gcc = program(COMPILER);
    gcc.args(FLAGS.split_whitespace())
        .arg(format!("-I{}", root().join("c/include").display()))
        .arg(format!("-I{}", folder.display()))
        .args([example.join("flight.c"), example.join("startup.c"), library])
        .args(["-nostdlib", "-Wl,--gc-sections", "-Wl,--no-warn-rwx-segments"])
        .arg(format!("-T{}", example.join("an386.ld").display()))
        .args(["-lgcc", "-o"])
        .arg(&image);
    capture(&mut gcc)?;
    Ok(image)
}

/// The committed flight as a table of C.
fn rows(path: &Path) -> Result<String> {
    let text = fs::read_to_string(path)?;
    let mut table = String::from("#include <stdint.h>\nstatic const int16_t flight_rows[][4] = {\n");
    for line in text.lines().filter(|line| !line.starts_with('#')).skip(1) {
        writeln!(table, "    {{{line}}},")?;
    }
    Ok(table + "};\n")
}
