//! The header: names, and the hint that belongs to a name that is not there.

use std::path::Path;

use crate::error::{LogError, Problem, clip};
use crate::import::is_altos;
use crate::records::Record;
use crate::{Column, Layout, Needs, Scale};

/// Unit suffixes of other systems, with the name that `gimbal convert` knows them by.
const OTHER_UNITS: [(&str, &str); 26] = [
    ("g", "g"),
    ("mg", "mg"),
    ("ftps2", "ftps2"),
    ("mps2", "mps2"),
    ("ms2", "mps2"),
    ("dps", "dps"),
    ("degps", "dps"),
    ("deg_s", "dps"),
    ("mdps", "mdps"),
    ("rpm", "rpm"),
    ("radps", "radps"),
    ("mradps", "mradps"),
    ("rad", "rad"),
    ("deg", "deg"),
    ("mrad", "mrad"),
    ("arcmin", "arcmin"),
    ("arcsec", "arcsec"),
    ("nm", "nm"),
    ("mnm", "mnm"),
    ("dyne_cm", "dyne_cm"),
    ("s", "s"),
    ("ms", "ms"),
    ("us", "us"),
    ("ns", "ns"),
    ("k", "k"),
    ("f", "f"),
];

/// Names of the header's cells.
pub(crate) fn names(file: &Path, record: &Record) -> Result<Vec<String>, LogError> {
    let cells: Vec<&[u8]> = match record {
        Record::Plain(bytes) if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") => {
            return Err(LogError::file(file, Problem::Utf16));
        }
        Record::Plain(bytes) => bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).split(|&b| b == b',').collect(),
        Record::Quoted(record) => record.iter().collect(),
        Record::Blank => return Err(LogError::line(file, 1, Problem::EmptyLine)),
        Record::Open => return Err(LogError::line(file, 1, Problem::OpenQuote)),
    };
    let mut names: Vec<String> = Vec::with_capacity(cells.len());
    for (index, cell) in cells.iter().enumerate() {
        let name = std::str::from_utf8(cell).map_err(|error| {
            let problem = Problem::NotUtf8 { offset: error.valid_up_to() + 1 };
            LogError::cell(file, 1, index, &clip(cell), problem)
        })?;
        let name = name.trim_start_matches('\u{feff}').trim();
        if let Some(first) = names.iter().position(|earlier| earlier == name)
            && !name.is_empty()
        {
            return Err(LogError::cell(file, 1, index, name, Problem::Duplicate { first: first + 1 }));
        }
        names.push(name.to_owned());
    }
    if let [only] = names.as_slice()
        && let Some(found) = only.chars().find(|c| [';', '\t', '|'].contains(c))
    {
        return Err(LogError::line(file, 1, Problem::Separator { found }));
    }
    Ok(names)
}

/// The layout that the log contract gives to a header, and what is worth a remark.
pub(crate) fn contract(file: &Path, names: Vec<String>, needs: Needs) -> Result<(Layout, Vec<String>), LogError> {
    let mut layout = Layout::new(names);
    for column in Column::ALL {
        if let Some(index) = layout.names().iter().position(|name| name == column.name()) {
            layout.assign(index, column, column.unit(), Scale::SI);
        }
    }
    let mut remarks = Vec::new();
    for column in Column::ALL.into_iter().filter(|&column| layout.position(column).is_none()) {
        let needed = needs.columns().contains(&column);
        let other = other_unit(&layout, column);
        match (needed, other) {
            (true, Some((index, unit))) => {
                let found = &layout.names()[index];
                let command = format!(
                    "`gimbal convert {} --map {}={found},unit={unit} --out FILE.csv`",
                    file.display(),
                    column.name()
                );
                let problem = Problem::OtherUnit {
                    name: column.name().to_owned(),
                    unit: column.unit().to_owned(),
                    purpose: needs.purpose(),
                    command,
                };
                return Err(LogError::cell(file, 1, index, found, problem));
            }
            (true, None) => {
                let problem = Problem::MissingColumn {
                    name: column.name().to_owned(),
                    unit: column.unit().to_owned(),
                    purpose: needs.purpose(),
                    hint: missing_hint(file, column.name(), &layout),
                };
                return Err(LogError::line(file, 1, problem));
            }
            (false, Some((index, _))) => remarks.push(format!(
                "column {} ({}) is not read: `{}` [{}] would be",
                index + 1,
                layout.names()[index],
                column.name(),
                column.unit()
            )),
            (false, None) => {}
        }
    }
    Ok((layout, remarks))
}

/// What to say when a column is not there.
fn missing_hint(file: &Path, wanted: &str, layout: &Layout) -> String {
    if is_altos(layout.names()) {
        let file = file.display();
        return format!("this is an AltOS export; make a log of it: `gimbal convert {file} --out FILE.csv`");
    }
    nearest_hint(wanted, layout.extra_names())
}

/// An extra column that is this quantity in another unit, and that unit.
fn other_unit(layout: &Layout, column: Column) -> Option<(usize, &'static str)> {
    layout.names().iter().enumerate().filter(|(index, _)| layout.roles()[*index].is_none()).find_map(|(index, name)| {
        let suffix = name.to_ascii_lowercase();
        let suffix = suffix.strip_prefix(column.stem())?.strip_prefix('_')?.to_owned();
        OTHER_UNITS.iter().find(|(known, _)| *known == suffix).map(|(_, unit)| (index, *unit))
    })
}

/// Likeness from which a name counts as meant, of 1.
const NEAR: f64 = 0.7;

/// What to say when a name is not among those there.
pub(crate) fn nearest_hint<'a>(wanted: &str, there: impl Iterator<Item = &'a str>) -> String {
    let distance = |name: &str| strsim::jaro_winkler(wanted, &name.to_ascii_lowercase());
    let there: Vec<&str> = there.filter(|name| !name.is_empty()).collect();
    let nearest = there.iter().copied().max_by(|a, b| distance(a).total_cmp(&distance(b)));
    match nearest {
        None => "add it to the header".to_owned(),
        Some(name) if distance(name) >= NEAR => format!("the nearest header is `{}`", clip(name.as_bytes())),
        Some(_) => {
            let names: Vec<String> = there.iter().take(12).map(|name| clip(name.as_bytes())).collect();
            format!(
                "none is near it in {}; if another program wrote the file, make a log of it with `gimbal convert`",
                names.join(", ")
            )
        }
    }
}
