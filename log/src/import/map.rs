//! Which column of a foreign file becomes which column of the log.

use std::io::Read;
use std::path::Path;

use super::unit;
use crate::error::{LogError, Problem};
use crate::{Column, Layout, Log, Reader, Scale, header};

/// Where a column comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// Name in the foreign header.
    pub name: String,
    /// Unit there, as in [`super::UNIT_NAMES`].
    pub unit: String,
    /// -1 where the axis points the other way.
    pub sign: f64,
}

/// The columns that are taken over, with what they become.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColumnMap(pub Vec<(Column, Source)>);

impl ColumnMap {
    /// Checks the units, and that nothing is taken twice.
    ///
    /// # Errors
    /// One line that says what is wrong.
    pub fn check(&self) -> Result<(), String> {
        for (index, (column, source)) in self.0.iter().enumerate() {
            if unit::scale(*column, &source.unit).is_none() {
                let known = unit::NAMES.iter().find(|(quantity, _)| *quantity == column.unit());
                let known = known.map_or("c, k, f", |(_, names)| names);
                return Err(format!("`{}` is not a unit of `{}`; use one of {known}", source.unit, column.name()));
            }
            for (earlier, other) in &self.0[..index] {
                if earlier == column {
                    return Err(format!("`{}` is mapped twice; map it once", column.name()));
                }
                if other.name == source.name {
                    let (first, second) = (earlier.name(), column.name());
                    return Err(format!("column `{}` is mapped to `{first}` and to `{second}`", source.name));
                }
            }
        }
        Ok(())
    }

    /// The layout of a file with these names: mapped columns, and those that bear the contract's names already.
    fn layout(&self, file: &Path, names: Vec<String>) -> Result<Layout, LogError> {
        let mut layout = Layout::new(names);
        for (column, source) in &self.0 {
            let Some(index) = layout.names().iter().position(|name| *name == source.name) else {
                let hint = header::nearest_hint(&source.name, layout.names().iter().map(String::as_str));
                return Err(LogError::line(file, 1, Problem::NoSource { name: source.name.clone(), hint }));
            };
            let Some(scale) = unit::scale(*column, &source.unit) else { continue };
            let scale = Scale { factor: source.sign * scale.factor, offset: source.sign * scale.offset };
            layout.assign(index, *column, &source.unit, scale);
        }
        for column in Column::ALL {
            let index = layout.names().iter().position(|name| name == column.name());
            if let Some(index) = index
                && layout.position(column).is_none()
                && layout.roles()[index].is_none()
            {
                layout.assign(index, column, column.unit(), Scale::SI);
            }
        }
        if layout.position(Column::Time).is_none() {
            let problem = Problem::MissingColumn {
                name: Column::Time.name().to_owned(),
                unit: "s".to_owned(),
                purpose: "to put the rows on one rate",
                hint: format!(
                    "name it with `--map time_s=COLUMN`; {}",
                    header::nearest_hint("time_s", layout.names().iter().map(String::as_str))
                ),
            };
            return Err(LogError::line(file, 1, problem));
        }
        Ok(layout)
    }
}

/// Reads a foreign CSV file through a map; its time stamps stay as they are. `file` is its name in messages.
///
/// # Errors
/// As [`Reader::with_layout`] and [`Reader::next_row`], and a map that does not fit the file.
pub fn read(source: impl Read, file: &Path, map: &ColumnMap) -> Result<Log, LogError> {
    map.check().map_err(|wrong| LogError::file(file, Problem::Map(wrong)))?;
    Log::read(Reader::with_layout(source, file, |file, names| map.layout(file, names))?)
}

/// The names in the header of any CSV file; `file` is its name in messages.
///
/// # Errors
/// The source cannot be read, or its header is not one.
pub fn header_names(source: impl Read, file: &Path) -> Result<Vec<String>, LogError> {
    let reader = Reader::with_layout(source, file, |_, names| Ok(Layout::new(names)))?;
    Ok(reader.layout().names().to_vec())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{ColumnMap, Source, read};
    use crate::Column;

    fn source(name: &str, unit: &str, sign: f64) -> Source {
        Source { name: name.to_owned(), unit: unit.to_owned(), sign }
    }

    #[test]
    fn closed_form_units_and_signs_are_applied() {
        let map = ColumnMap(vec![
            (Column::Time, source("t_ms", "ms", 1.0)),
            (Column::AccelX, source("ax", "g", -1.0)),
            (Column::VehicleRate, source("rate", "dps", 1.0)),
        ]);
        let text = "t_ms,ax,rate,accel_z_mps2,note\n0,1,180,9.8,a\n1,,,,b\n";
        let log = read(text.as_bytes(), Path::new("x.csv"), &map).expect("reads");
        let first = log.row(0);
        assert!((first[Column::AccelX] + 9.806_65).abs() < 1e-12);
        assert!((first[Column::VehicleRate] - std::f64::consts::PI).abs() < 1e-12);
        assert!((first[Column::AccelZ] - 9.8).abs() < 1e-12);
        assert!((log.row(1)[Column::Time] - 1e-3).abs() < 1e-15 && log.row(1)[Column::AccelX].is_nan());
        assert_eq!(log.extras()[0].cell(1), "b");
    }

    #[test]
    fn contract_a_wrong_map_is_told_with_what_would_be_right() {
        let told = |column, name: &str, unit: &str| {
            let map = ColumnMap(vec![(Column::Time, source("t", "s", 1.0)), (column, source(name, unit, 1.0))]);
            read(&b"t,gyro_pitch\n0,0\n"[..], Path::new("x.csv"), &map).expect_err("wrong").to_string()
        };
        assert_eq!(
            told(Column::VehicleRate, "gyro_pich", "dps"),
            "x.csv: line 1: there is no column `gyro_pich`; the nearest header is `gyro_pitch`"
        );
        assert_eq!(
            told(Column::VehicleRate, "gyro_pitch", "deg"),
            "x.csv: `deg` is not a unit of `vehicle_rate_radps`; use one of radps, mradps, dps, mdps, rpm"
        );
    }
}
