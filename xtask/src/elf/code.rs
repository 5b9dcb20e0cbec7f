//! Functions of an image: how far each grows the stack, and where it goes.

use super::{Image, riscv, thumb};
use anyhow::{Context, Result, ensure};
use std::collections::BTreeMap;

/// What one instruction does, as far as it matters here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effect {
    None,
    /// The stack grows by so many bytes.
    Grow(u32),
    /// The stack changes by an amount that the instruction does not tell.
    Unknown(&'static str),
    /// Calls the function at this address.
    Call(u32),
    /// Goes to this address: inside the function, or a call in its last place.
    Jump(u32),
    /// Goes somewhere that the binary does not tell.
    Indirect,
}

pub(super) struct Step {
    pub(super) bytes: usize,
    pub(super) effect: Effect,
}

/// One function.
#[derive(Debug, Clone)]
pub(crate) struct Function {
    /// All its names; the linker merges equal functions, and libraries give one several names.
    pub(crate) names: Vec<String>,
    pub(crate) bytes: u32,
    /// Stack that it takes itself, at most: everything it pushes or reserves on any path, added up.
    pub(crate) frame_bytes: u32,
    /// Addresses of the functions that it calls.
    pub(crate) calls: Vec<u32>,
    /// What keeps its stack or its calls from being known.
    pub(crate) obstacles: Vec<String>,
}

impl Function {
    pub(crate) fn name(&self) -> String {
        self.names.iter().map(|name| format!("{:#}", rustc_demangle::demangle(name))).min().unwrap_or_default()
    }
}

/// Every function of the image by its address.
pub(crate) fn functions(image: &Image) -> Result<BTreeMap<u32, Function>> {
    let mut names: BTreeMap<u32, (u32, Vec<String>)> = BTreeMap::new();
    for symbol in image.symbols.iter().filter(|symbol| symbol.is_function && !symbol.name.starts_with('$')) {
        let entry = names.entry(symbol.address).or_default();
        entry.0 = entry.0.max(symbol.bytes);
        entry.1.push(symbol.name.clone());
    }
    let starts: Vec<u32> = names.keys().copied().collect();
    let mut functions = BTreeMap::new();
    for (index, (address, (size, names))) in names.into_iter().enumerate() {
        let section = image
            .sections
            .iter()
            .find(|section| section.loaded && address >= section.address && address - section.address < section.bytes);
        let Some(section) = section else { continue };
        // Some written in assembly have no size: they end where the next one starts.
        let next = starts.get(index + 1).map_or(section.address + section.bytes, |&next| next);
        let bytes = if size == 0 { next - address } else { size };
        let start = (address - section.address) as usize;
        let code = section.data.get(start..start + bytes as usize).context("a function outside its section")?;
        functions.insert(address, examine(image, names, address, code)?);
    }
    Ok(functions)
}

fn examine(image: &Image, names: Vec<String>, address: u32, code: &[u8]) -> Result<Function> {
    let bytes = u32::try_from(code.len())?;
    let mut function = Function { names, bytes, frame_bytes: 0, calls: Vec::new(), obstacles: Vec::new() };
    let mut at = 0;
    while at < code.len() {
        let here = address + u32::try_from(at)?;
        if let Some(end) = image.data_until(here) {
            at += (end - here) as usize;
            continue;
        }
        let decode = if image.is_thumb { thumb::decode } else { riscv::decode };
        let Some(step) = decode(&code[at..], here) else { break };
        ensure!(step.bytes > 0, "an instruction without length");
        match step.effect {
            Effect::None => {}
            Effect::Grow(more) => function.frame_bytes += more,
            Effect::Unknown(why) => function.obstacles.push(format!("{why} at {here:#x}")),
            Effect::Jump(target) if target >= address && target - address < bytes => {}
            // Armv6-M has no other far jump than `bl`; one to the first instruction is taken for recursion.
            Effect::Call(target) if target > address && target - address < bytes => {}
            Effect::Call(target) | Effect::Jump(target) => function.calls.push(target),
            Effect::Indirect => function.obstacles.push(format!("indirect call at {here:#x}")),
        }
        at += step.bytes;
    }
    Ok(function)
}
