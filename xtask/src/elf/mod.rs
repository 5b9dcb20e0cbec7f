//! What the images contain, read from the binary itself.

use anyhow::{Context, Result, bail};
use object::{Object, ObjectSection, ObjectSymbol, SectionKind, SymbolKind};
use std::fs;
use std::path::Path;

/// A linked image.
pub(crate) struct Image {
    pub(crate) sections: Vec<Section>,
    pub(crate) symbols: Vec<Symbol>,
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
        let thumb = file.architecture() == object::Architecture::Arm;
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
        for symbol in file.symbols() {
            let is_function = symbol.kind() == SymbolKind::Text;
            let bit = u64::from(thumb && is_function);
            symbols.push(Symbol {
                name: symbol.name()?.to_owned(),
                address: u32::try_from(symbol.address() & !bit)?,
                bytes: u32::try_from(symbol.size())?,
                is_function,
            });
        }
        Ok(Self { sections, symbols })
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
