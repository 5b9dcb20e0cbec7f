//! Stage `target-budget`: what the step takes on each board, committed as text in `firmware/budget/` and compared, so
//! that every change of it is seen in review. `cargo xtask budget` writes the files anew.
//!
//! The figures are exact for one compiler; another one (Debian's, a newer one) is held to them within a tenth.

use super::boards::{self, Board};
use super::cost::{self, Cost};
use super::toolchain::Toolchain;
use crate::shell::{root, version_of};
use crate::stages::Note;
use anyhow::{Context, Result, bail};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

/// How far another compiler may lie above the committed figure.
const OTHER_COMPILER: f64 = 1.1;

pub(crate) fn check() -> Result<Note> {
    let mut complaints = Vec::new();
    let boards = boards::all()?;
    for board in &boards {
        let measured = text(board, &cost::measure(board)?)?;
        let path = file(board);
        let committed = fs::read_to_string(&path)
            .with_context(|| format!("{} is missing; `cargo xtask budget` writes it", path.display()))?;
        complaints.extend(compare(&board.name, &committed, &measured)?);
    }
    if complaints.is_empty() {
        return Ok(format!("{} boards", boards.len()));
    }
    bail!("the figures have changed; if that is meant, `cargo xtask budget`\n{}", complaints.join("\n"))
}

pub(crate) fn write() -> Result<()> {
    for board in &boards::all()? {
        let path = file(board);
        fs::create_dir_all(path.parent().context("no folder")?)?;
        fs::write(&path, text(board, &cost::measure(board)?)?)?;
        eprintln!("wrote {}", path.display());
    }
    Ok(())
}

fn file(board: &Board) -> PathBuf {
    root().join("firmware/budget").join(format!("{}.txt", board.name))
}

/// The figures as a table, one line each.
pub(crate) fn text(board: &Board, costs: &BTreeMap<&'static str, Cost>) -> Result<String> {
    let mut text = format!("{}, {}, {}\ncompiler: {}\n\n", board.name, board.core, board.target, compiler(board)?);
    let numbers: Vec<&str> = costs.keys().copied().collect();
    writeln!(text, "{:<44}{:>12}{:>12}", "", numbers[0], numbers[1])?;
    let mut row = |name: &str, of: &dyn Fn(&Cost) -> String| {
        write!(text, "{name:<44}")?;
        costs.values().try_for_each(|cost| write!(text, "{:>12}", of(cost)))?;
        writeln!(text)
    };
    row("state of an axis [bytes]", &|cost| cost.state_bytes.to_string())?;
    row("law of an axis [bytes]", &|cost| cost.law_bytes.to_string())?;
    row("state of an axis with effects [bytes]", &|cost| cost.effects_bytes[0].to_string())?;
    row("law of an axis with effects [bytes]", &|cost| cost.effects_bytes[1].to_string())?;
    row("state of the estimator [bytes]", &|cost| cost.estimator_bytes[0].to_string())?;
    row("law of the estimator [bytes]", &|cost| cost.estimator_bytes[1].to_string())?;
    row("code of the step [bytes]", &|cost| cost.code_bytes.to_string())?;
    row("code of the step with effects [bytes]", &|cost| cost.effects_code_bytes.to_string())?;
    row("code of estimator and monitor [bytes]", &|cost| cost.aids_code_bytes.to_string())?;
    row("constants of all [bytes]", &|cost| cost.constant_bytes.to_string())?;
    row("static RAM of all [bytes]", &|cost| cost.static_ram_bytes.to_string())?;
    row("stack of the step, at most [bytes]", &|cost| cost.stack_bytes.to_string())?;
    row("stack of the step with effects [bytes]", &|cost| cost.effects_stack_bytes.to_string())?;
    row("stack of estimator and monitor [bytes]", &|cost| cost.aids_stack_bytes.to_string())?;
    let profiles: BTreeSet<&String> = costs.values().flat_map(|cost| cost.instructions.keys()).collect();
    for profile in profiles {
        let count = |cost: &Cost| cost.instructions.get(profile).copied();
        row(&format!("{profile}: steps"), &|cost| count(cost).map_or("-".into(), |c| c.steps.to_string()))?;
        row(&format!("{profile}: least instructions"), &|cost| count(cost).map_or("-".into(), |c| c.min.to_string()))?;
        row(&format!("{profile}: mean"), &|cost| count(cost).map_or("-".into(), |c| format!("{:.1}", c.mean)))?;
        row(&format!("{profile}: most"), &|cost| count(cost).map_or("-".into(), |c| c.max.to_string()))?;
    }
    let inexact: BTreeSet<&String> = costs.values().flat_map(|cost| cost.errors_ppm.keys()).collect();
    for name in inexact {
        let error = |cost: &Cost| cost.errors_ppm.get(name).map_or("-".into(), ToString::to_string);
        row(&format!("{name}: largest error [1e-6]"), &error)?;
    }
    for (number, cost) in costs {
        writeln!(text, "\n{number}, deepest calls [bytes of stack]:\n  {}", cost.deepest.replace(" > ", "\n  "))?;
        let library = if cost.library.is_empty() { "nothing".into() } else { cost.library.join(" ") };
        writeln!(text, "{number}, called in the run-time library: {library}")?;
    }
    Ok(text)
}

fn compiler(board: &Board) -> Result<String> {
    let program = match Toolchain::ready(&board.target)? {
        Toolchain::Rustup => "rustc",
        Toolchain::Debian => "/usr/bin/rustc",
    };
    let line = version_of(program).context("no compiler")?;
    Ok(line.split_whitespace().take(2).collect::<Vec<_>>().join(" "))
}

/// Lines that differ; between compilers only figures that have grown beyond the allowance.
fn compare(board: &str, committed: &str, measured: &str) -> Result<Vec<String>> {
    let compiler_of = |text: &str| text.lines().nth(1).map(str::to_owned);
    if compiler_of(committed) == compiler_of(measured) {
        let (old, new): (Vec<&str>, Vec<&str>) = (committed.lines().collect(), measured.lines().collect());
        let gone = old.iter().filter(|line| !new.contains(line)).map(|line| format!("{board} - {line}"));
        let come = new.iter().filter(|line| !old.contains(line)).map(|line| format!("{board} + {line}"));
        return Ok(gone.chain(come).collect());
    }
    let (old, new) = (figures(committed), figures(measured));
    let mut complaints = Vec::new();
    for (name, values) in new {
        let before = old.get(&name).with_context(|| format!("{board}: no committed figure `{name}`"))?;
        for (now, then) in values.iter().zip(before) {
            if *now > then * OTHER_COMPILER {
                complaints.push(format!("{board} {name}: {now}, committed {then}"));
            }
        }
    }
    Ok(complaints)
}

/// The lines of the table: a name of 44 characters, then numbers.
fn figures(text: &str) -> BTreeMap<String, Vec<f64>> {
    let rows = text.lines().filter_map(|line| {
        let (name, rest) = line.split_at_checked(44)?;
        let values: Vec<f64> = rest.split_whitespace().map(str::parse).collect::<Result<_, _>>().ok()?;
        (!values.is_empty()).then(|| (name.trim().to_owned(), values))
    });
    rows.collect()
}
