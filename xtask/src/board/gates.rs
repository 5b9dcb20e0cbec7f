//! Stage `target-gates`: nothing that a step, with effects or without, an estimate or the gap monitor can reach panics,
//! allocates, computes in double precision, recurses or calls through a pointer. Each gate is also shown to close, on each
//! of these functions spoilt on purpose.

use super::boards::{self, Board};
use super::image;
use crate::elf::{self, Image, Reach};
use crate::stages::Note;
use anyhow::{Context, Result, bail, ensure};
use std::path::{Path, PathBuf};

/// The functions that `firmware/src/bin/step.rs` exports, by number system: the step, estimator with monitor.
pub(crate) const ROOTS: [(&str, [&str; 2]); 2] =
    [("f32", ["step_f32", "aids_f32"]), ("fixed", ["step_fixed", "aids_fixed"])];

fn roots() -> impl Iterator<Item = &'static str> {
    ROOTS.into_iter().flat_map(|(_, roots)| roots)
}

/// The laws that are gated: the nominal one, and by a feature of the firmware that with effects.
const LAWS: [Option<&str>; 2] = [None, Some("effects")];

/// Features of the firmware that spoil each function, and what the gate then says.
const SPOILT: [(&str, &str); 5] = [
    ("bad-panic", "panic"),
    ("bad-double", "double precision"),
    ("bad-alloc", "no global memory allocator found"),
    ("bad-recursion", "calls itself"),
    ("bad-indirect", "indirect call"),
];

pub(crate) fn check() -> Result<Note> {
    let boards = boards::one_for_each_target()?;
    for board in &boards {
        for law in LAWS {
            let image = plain(board, law)?;
            for root in roots() {
                gate(&image, root).with_context(|| format!("{} {root} {}", board.target, law.unwrap_or_default()))?;
            }
        }
        for (feature, expected) in SPOILT {
            closes(board, feature, expected)?;
        }
        println!(
            "{}: no panic, double, allocation, recursion or indirect call from {}, nor with effects; each gate closes",
            board.target,
            roots().collect::<Vec<_>>().join(", ")
        );
    }
    Ok(format!("{} targets, {} functions, {} laws", boards.len(), roots().count(), LAWS.len()))
}

/// The program as it is; where it does not link because something panics, the ways to the panic.
fn plain(board: &Board, law: Option<&str>) -> Result<PathBuf> {
    match image::step(board, law) {
        Err(error) if format!("{error:#}").contains("panic-never") => {
            bail!("{}: a function of the tick can panic:\n{}", board.target, ways_to_panic(board, law)?)
        }
        image => image,
    }
}

/// Fails unless the gate closes on every function, for the expected reason. A panic and an allocation already stop the
/// linker, which tells no functions apart.
fn closes(board: &Board, feature: &str, expected: &str) -> Result<()> {
    let image = match image::step(board, Some(feature)) {
        Ok(image) => image,
        Err(error) if format!("{error:#}").contains(expected) => return Ok(()),
        Err(error) => return Err(error.context(format!("{feature} does not build for another reason"))),
    };
    for root in roots() {
        match gate(&image, root) {
            Err(error) if format!("{error:#}").contains(expected) => {}
            Err(error) => return Err(error.context(format!("the gate closes on {feature} for another reason"))),
            Ok(()) => bail!("{}: the gate let {feature} through in {root}", board.target),
        }
    }
    Ok(())
}

/// Passes if the function does nothing forbidden.
fn gate(image: &Path, root: &str) -> Result<()> {
    let complaints = complaints(image, root)?;
    ensure!(complaints.is_empty(), "{}", complaints.join("\n"));
    Ok(())
}

/// What a function can reach that it must not, each with the calls that lead there.
fn complaints(image: &Path, root: &str) -> Result<Vec<String>> {
    let functions = elf::functions(&Image::read(image)?)?;
    let reach = Reach::from(&functions, root)?;
    let mut complaints = Vec::new();
    for (function, path) in &reach.functions {
        for name in &function.names {
            if let Some(why) = forbidden(name) {
                complaints.push(format!("{name} {why}: {path}"));
            }
        }
        complaints.extend(function.obstacles.iter().map(|obstacle| format!("{obstacle}: {path}")));
    }
    Ok(complaints)
}

/// Passes if a whole program, and not its tick alone, holds no function that computes with doubles.
pub(crate) fn without_doubles(program: &Path) -> Result<()> {
    let functions = elf::functions(&Image::read(program)?)?;
    let names = functions.values().flat_map(|function| &function.names);
    let doubles: Vec<&str> = names.map(String::as_str).filter(|name| forbidden(name) == Some(DOUBLES)).collect();
    ensure!(doubles.is_empty(), "{} computes with doubles: {}", program.display(), doubles.join(" "));
    Ok(())
}

const DOUBLES: &str = "computes in double precision";

/// Why the function of that name must not be reached, if so.
fn forbidden(name: &str) -> Option<&'static str> {
    // Run-time library of Arm: `__aeabi_dadd`, `__aeabi_f2d`; of GCC: `__adddf3`, `__fixdfsi`, `__extendsfdf2`.
    const DOUBLE: [&str; 8] = ["df3", "df2", "dfsi", "dfdi", "sidf", "didf", "sfdf", "dfsf"];
    let arm = name.strip_prefix("__aeabi_");
    if arm.is_some_and(|rest| rest.starts_with('d') || rest.starts_with("cd") || rest.ends_with("2d")) {
        return Some(DOUBLES);
    }
    if name.starts_with("__") && DOUBLE.iter().any(|part| name.contains(part)) {
        return Some(DOUBLES);
    }
    let allocates = ["__rust_alloc", "__rust_realloc", "__rustc", "_RNvC", "GlobalAlloc"];
    if name.contains("alloc") && allocates.iter().any(|part| name.contains(part)) {
        return Some("allocates");
    }
    (name.contains("panic") || name.contains("rust_begin_unwind")).then_some("panics")
}

/// Every way from one of the functions to a panic, from an image that is allowed to have one.
fn ways_to_panic(board: &Board, law: Option<&str>) -> Result<String> {
    let functions = elf::functions(&Image::read(&image::step_that_may_panic(board, law)?)?)?;
    let mut ways = Vec::new();
    for root in roots() {
        let reach = Reach::from(&functions, root)?;
        let panics = |names: &[String]| names.iter().any(|name| forbidden(name) == Some("panics"));
        ways.extend(reach.functions.into_iter().filter(|(f, _)| panics(&f.names)).map(|(_, path)| path));
    }
    Ok(ways.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::forbidden;

    #[test]
    fn names_of_the_run_time_library_are_told_apart() {
        for bad in ["__aeabi_dmul", "__aeabi_f2d", "__aeabi_cdcmple", "__aeabi_l2d", "__muldf3", "__extendsfdf2"] {
            assert_eq!(forbidden(bad), Some("computes in double precision"), "{bad}");
        }
        for good in ["__aeabi_fadd", "__aeabi_f2iz", "__addsf3", "__aeabi_lmul", "__aeabi_memcpy", "__floatsisf"] {
            assert_eq!(forbidden(good), None, "{good}");
        }
    }
}
