//! The column map, from the command line or a TOML file.

use std::collections::BTreeMap;
use std::path::Path;

use gimbal_log::Column;
use gimbal_log::import::Source;
use serde::Deserialize;

use crate::exit::Failure;

/// One column of the log, and where it comes from.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) column: Column,
    pub(crate) source: Source,
}

/// An entry as it stands in a map file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    column: String,
    unit: Option<String>,
    sign: Option<f64>,
}

/// `accel_x_mps2=ax[,unit=g][,sign=-1]`.
pub(crate) fn entry(text: &str) -> Result<Entry, String> {
    let (column, rest) = text.split_once('=').ok_or("write COLUMN=NAME, such as accel_x_mps2=ax,unit=g")?;
    let mut parts = rest.split(',');
    let mut written = Written { column: parts.next().unwrap_or_default().to_owned(), unit: None, sign: None };
    for part in parts {
        match part.split_once('=') {
            Some(("unit", unit)) => written.unit = Some(unit.to_owned()),
            Some(("sign", sign)) => {
                written.sign = Some(sign.parse().map_err(|_| format!("sign is `{sign}`; write 1 or -1"))?);
            }
            _ => return Err(format!("`{part}` is neither `unit=...` nor `sign=...`")),
        }
    }
    checked(column, written)
}

/// The entries of a map file.
pub(crate) fn file(path: &Path) -> Result<Vec<Entry>, Failure> {
    let wrong = |what: &str| Failure::input(format!("{}: {what}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| wrong(&format!("cannot be read: {error}")))?;
    let tables: BTreeMap<String, Written> = toml::from_str(&text).map_err(|error| {
        let line = error.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1);
        wrong(&format!("line {line}: {}", error.message()))
    })?;
    tables.into_iter().map(|(column, written)| checked(&column, written).map_err(|what| wrong(&what))).collect()
}

#[allow(clippy::float_cmp, reason = "a sign is exactly 1 or -1")]
fn checked(column: &str, written: Written) -> Result<Entry, String> {
    let Some(known) = Column::named(column) else {
        let names: Vec<&str> = Column::ALL.into_iter().map(Column::name).collect();
        return Err(format!("`{column}` is not a column of a log; the columns are {}", names.join(", ")));
    };
    let sign = written.sign.unwrap_or(1.0);
    if sign.abs() != 1.0 {
        return Err(format!("the sign of `{column}` is {sign}; write 1 or -1"));
    }
    let si = match known.unit() {
        "m/s2" => "mps2",
        "rad/s" => "radps",
        "N m" => "nm",
        "deg C" => "c",
        other => other,
    };
    let unit = written.unit.unwrap_or_else(|| si.to_owned());
    Ok(Entry { column: known, source: Source { name: written.column, unit, sign } })
}
