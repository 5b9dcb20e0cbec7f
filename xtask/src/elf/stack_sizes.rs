//! The compiler's own record of stack frames: sections `.stack_sizes`, written with `-Z emit-stack-sizes`.

use anyhow::{Context, Result};
use object::{Object, ObjectSection};
use std::fs;
use std::path::Path;

/// Address and frame [bytes] of every function that the compiler made.
pub(crate) fn stack_sizes(path: &Path) -> Result<Vec<(u32, u32)>> {
    let bytes = fs::read(path).with_context(|| path.display().to_string())?;
    let file = object::File::parse(bytes.as_slice())?;
    let thumb_bit = u32::from(file.architecture() == object::Architecture::Arm);
    let mut sizes = Vec::new();
    for section in file.sections() {
        if section.name()? != ".stack_sizes" {
            continue;
        }
        let mut data = section.data()?;
        while let Some((address, rest)) = data.split_first_chunk::<4>() {
            data = rest;
            let size = uleb128(&mut data).context("a stack size without end")?;
            let address = u32::from_le_bytes(*address) & !thumb_bit;
            // Functions that the linker dropped keep their record, at address 0.
            if address != 0 {
                sizes.push((address, size));
            }
        }
    }
    Ok(sizes)
}

/// A number in groups of seven bits, lowest first, the top bit set on all but the last.
fn uleb128(data: &mut &[u8]) -> Option<u32> {
    let mut value = 0;
    for shift in (0..32).step_by(7) {
        let (&byte, rest) = data.split_first()?;
        *data = rest;
        value |= u32::from(byte & 0x7F) << shift;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::uleb128;

    #[test]
    fn numbers_of_several_bytes_are_read() {
        let mut data = [0xE5, 0x8E, 0x26, 7].as_slice();
        assert_eq!(uleb128(&mut data), Some(624_485));
        assert_eq!(data, [7]);
        assert_eq!(uleb128(&mut [0x80].as_slice()), None);
    }
}
