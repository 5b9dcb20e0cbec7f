//! Stage `target-gates`: nothing that a step can reach panics, allocates, computes in double precision, recurses or
//! calls through a pointer. Each gate is also shown to close, on a step that was spoilt on purpose.

use super::boards::{self, Board};
use super::image;
use crate::elf::{self, Image, Reach};
use crate::stages::Note;
use anyhow::{Context, Result, bail, ensure};
use std::path::Path;

/// The functions that `firmware/src/bin/step.rs` exports.
pub(crate) const ROOTS: [(&str, &str); 2] = [("f32", "step_f32"), ("fixed", "step_fixed")];

/// Features of the firmware that spoil the step, and what the gate then says.
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
        gate(board, None)?;
        for (feature, expected) in SPOILT {
            match gate(board, Some(feature)) {
                Err(error) if format!("{error:#}").contains(expected) => {}
                Err(error) => return Err(error.context(format!("the gate closes on {feature} for another reason"))),
                Ok(()) => bail!("{}: the gate let {feature} through", board.target),
            }
        }
        println!("{}: no panic, double, allocation, recursion or indirect call; each gate closes", board.target);
    }
    Ok(format!("{} targets", boards.len()))
}

/// Passes if the step, spoilt by `feature` or not, does nothing forbidden.
fn gate(board: &Board, feature: Option<&str>) -> Result<()> {
    let path = match image::step(board, feature) {
        Ok(path) => path,
        Err(error) if format!("{error:#}").contains("panic-never") && feature.is_none() => {
            bail!("{}: a step can panic:\n{}", board.target, ways_to_panic(board)?)
        }
        Err(error) => return Err(error),
    };
    for (_, root) in ROOTS {
        let complaints = complaints(&path, root).with_context(|| format!("{} {root}", board.target))?;
        if !complaints.is_empty() {
            bail!("{} {root}:\n{}", board.target, complaints.join("\n"));
        }
    }
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

/// Passes if a whole program, and not its step alone, holds no function that computes with doubles.
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

/// Every way from a step to a panic, from an image that is allowed to have one.
fn ways_to_panic(board: &Board) -> Result<String> {
    let functions = elf::functions(&Image::read(&image::step(board, Some("panic-allowed"))?)?)?;
    let mut ways = Vec::new();
    for (_, root) in ROOTS {
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
