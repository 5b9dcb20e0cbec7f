//! One row of numbers, from the cells of one record.

use std::ops::{Index, IndexMut};

use crate::batch::Texts;
use crate::cell::{self, Cell};
use crate::error::{Problem, clip};
use crate::{Column, Layout};

/// One row in SI units; a missing sample, and a column that the file does not have, is NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row([f64; Column::COUNT]);

impl Row {
    /// Everything missing.
    pub const MISSING: Self = Self([f64::NAN; Column::COUNT]);
}

impl Index<Column> for Row {
    type Output = f64;

    fn index(&self, column: Column) -> &f64 {
        &self.0[column.index()]
    }
}

impl IndexMut<Column> for Row {
    fn index_mut(&mut self, column: Column) -> &mut f64 {
        &mut self.0[column.index()]
    }
}

/// Column, where there is one, and problem.
pub(crate) type Wrong = (Option<usize>, Problem);

/// Cells between commas, parsed where they stand.
pub(crate) fn plain(
    record: &[u8],
    layout: &Layout,
    row: &mut Row,
    missing: &mut [u64; Column::COUNT],
    mut extras: Option<&mut Texts>,
) -> Result<(), Wrong> {
    utf8(record)?;
    let roles = layout.roles();
    let mut rest = record;
    for (index, role) in roles.iter().enumerate() {
        let used = if let Some(column) = role {
            let (value, used) = cell::leading(rest);
            row[*column] = number(value, &rest[..used], *column, index, layout, missing)?;
            used
        } else {
            let used = memchr::memchr(b',', rest).unwrap_or(rest.len());
            if let Some(extras) = &mut extras {
                extras.push(&rest[..used]);
            }
            used
        };
        let last = index + 1 == roles.len();
        if last != (used == rest.len()) {
            let found = memchr::memchr_iter(b',', record).count() + 1;
            return Err((None, Problem::Ragged { found, expected: roles.len() }));
        }
        rest = rest.get(used + 1..).unwrap_or_default();
    }
    Ok(())
}

/// Cells that were in quotes.
pub(crate) fn quoted(
    record: &csv::ByteRecord,
    layout: &Layout,
    row: &mut Row,
    missing: &mut [u64; Column::COUNT],
    mut extras: Option<&mut Texts>,
) -> Result<(), Wrong> {
    if record.len() != layout.roles().len() {
        return Err((None, Problem::Ragged { found: record.len(), expected: layout.roles().len() }));
    }
    for (index, (bytes, role)) in record.iter().zip(layout.roles()).enumerate() {
        utf8(bytes).map_err(|(_, problem)| (Some(index), problem))?;
        match role {
            Some(column) => row[*column] = number(cell::whole(bytes), bytes, *column, index, layout, missing)?,
            None => {
                if let Some(extras) = &mut extras {
                    extras.push(bytes);
                }
            }
        }
    }
    Ok(())
}

fn utf8(bytes: &[u8]) -> Result<(), Wrong> {
    if bytes.is_ascii() {
        return Ok(());
    }
    std::str::from_utf8(bytes).map(|_| ()).map_err(|error| {
        let offset = error.valid_up_to() + 1;
        let index = memchr::memchr_iter(b',', &bytes[..offset - 1]).count();
        (Some(index), Problem::NotUtf8 { offset })
    })
}

#[inline]
fn number(
    value: Cell,
    bytes: &[u8],
    column: Column,
    index: usize,
    layout: &Layout,
    missing: &mut [u64; Column::COUNT],
) -> Result<f64, Wrong> {
    let unit = || layout.unit(index).to_owned();
    match value {
        Cell::Number(value) => Ok(layout.to_si(column, value)),
        Cell::Missing if column == Column::Time => Err((Some(index), Problem::NoTime)),
        Cell::Missing => {
            missing[column.index()] += 1;
            Ok(f64::NAN)
        }
        Cell::NotFinite => Err((Some(index), Problem::NotFinite { text: clip(bytes), unit: unit() })),
        Cell::Text => Err((Some(index), Problem::NotANumber { text: clip(bytes.trim_ascii()), unit: unit() })),
    }
}
