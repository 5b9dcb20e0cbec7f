//! What the images contain, read from the binary itself.

mod clocks;
mod code;
mod reach;
mod riscv;
mod stack_sizes;
mod thumb;

pub(crate) use clocks::cortex_m0;
pub(crate) use code::{Function, functions};
pub(crate) use reach::{Reach, addresses};
pub(crate) use stack_sizes::stack_sizes;

use anyhow::{Context, Result, bail};
use object::{Object, ObjectSection, ObjectSymbol, SectionKind, SymbolKind};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A linked image.
pub(crate) struct Image {
    pub(crate) sections: Vec<Section>,
    pub(crate) symbols: Vec<Symbol>,
    /// Thumb code, else RISC-V.
    pub(crate) is_thumb: bool,
    /// Where code (false) and data among code (true) start, from the mapping symbols `$t`, `$x` and `$d`.
    mapping: BTreeMap<u32, bool>,
}

/// A part of the image that takes memory on the board.
pub(crate) struct Section {
    pub(crate) name: String,
    pub(crate) address: u32,
    pub(crate) bytes: u32,
    /// Comes from the image, unlike zeroed or unset memory.
    pub(crate) loaded: bool,
    pub(crate) data: Vec<u8>,
}

#[derive(Debug, Clone)]
pub(crate) struct Symbol {
    pub(crate) name: String,
    /// Without the bit that marks Thumb code.
    pub(crate) address: u32,
    pub(crate) bytes: u32,
    pub(crate) is_function: bool,
}

impl Image {
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).with_context(|| path.display().to_string())?;
        let file = object::File::parse(bytes.as_slice())?;
        let is_thumb = file.architecture() == object::Architecture::Arm;
        let mut sections = Vec::new();
        for section in file.sections() {
            let allocated = matches!(section.flags(), object::SectionFlags::Elf { sh_flags, .. } if sh_flags.contains(object::elf::SHF_ALLOC));
            if !allocated || section.size() == 0 {
                continue;
            }
            sections.push(Section {
                name: section.name()?.to_owned(),
                address: u32::try_from(section.address())?,
                bytes: u32::try_from(section.size())?,
                loaded: section.kind() != SectionKind::UninitializedData,
                data: section.data()?.to_vec(),
            });
        }
        let mut symbols = Vec::new();
        let mut mapping = BTreeMap::new();
        for symbol in file.symbols() {
            let is_function = symbol.kind() == SymbolKind::Text;
            let bit = u64::from(is_thumb && is_function);
            match symbol.name()? {
                name if name.starts_with("$d") => drop(mapping.insert(u32::try_from(symbol.address())?, true)),
                name if name.starts_with('$') => drop(mapping.insert(u32::try_from(symbol.address())?, false)),
                _ => {}
            }
            symbols.push(Symbol {
                name: symbol.name()?.to_owned(),
                address: u32::try_from(symbol.address() & !bit)?,
                bytes: u32::try_from(symbol.size())?,
                is_function,
            });
        }
        Ok(Self { sections, symbols, is_thumb, mapping })
    }

    /// If `address` lies in data among code, where that data ends.
    fn data_until(&self, address: u32) -> Option<u32> {
        let (_, &is_data) = self.mapping.range(..=address).next_back()?;
        let end = self.mapping.range(address + 1..).next().map_or(u32::MAX, |(&end, _)| end);
        is_data.then_some(end)
    }

    /// The half word at an address.
    pub(crate) fn half_word(&self, address: u32) -> Option<u16> {
        self.sections.iter().filter(|section| section.loaded).find_map(|section| {
            let at = address.checked_sub(section.address)? as usize;
            let bytes = section.data.get(at..at + 2)?;
            Some(u16::from_le_bytes([bytes[0], bytes[1]]))
        })
    }

    /// Bytes of all sections whose name starts so.
    pub(crate) fn section_bytes(&self, prefix: &str) -> u32 {
        self.sections.iter().filter(|section| section.name.starts_with(prefix)).map(|section| section.bytes).sum()
    }

    /// The one symbol of that name.
    pub(crate) fn symbol(&self, name: &str) -> Result<&Symbol> {
        match self.symbols.iter().filter(|symbol| symbol.name == name).collect::<Vec<_>>().as_slice() {
            [symbol] => Ok(symbol),
            [] => bail!("the image has no symbol {name}"),
            _ => bail!("the image has several symbols {name}"),
        }
    }
}
