//! The rows of a sweep as a Parquet file: one column of doubles a parameter and a metric, null where a cell is empty.

use std::io::Write;
use std::sync::Arc;

use parquet::data_type::{DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;

/// Rows that are held in memory at once.
const GROUP: usize = 8192;

/// Writes rows of text; `header` names their columns, the first of which numbers the runs.
pub(super) fn write(
    header: &str,
    rows: impl Iterator<Item = std::io::Result<String>>,
    file: &mut (impl Write + Send),
) -> Result<()> {
    let columns: Vec<String> =
        header.split(',').skip(1).map(|name| format!("optional double {};", plain(name))).collect();
    let schema = parse_message_type(&format!("message sweep {{ required int64 run; {} }}", columns.concat()))?;
    // Values that hardly repeat gain nothing from a dictionary.
    let properties = WriterProperties::builder().set_dictionary_enabled(false).build();
    let mut writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    let mut runs = Vec::with_capacity(GROUP);
    let mut cells = vec![Vec::with_capacity(GROUP); columns.len()];
    for row in rows {
        let row = row?;
        let mut row = row.split(',');
        runs.push(
            row.next()
                .and_then(|run| run.parse().ok())
                .ok_or_else(|| ParquetError::General("a row without a number".to_owned()))?,
        );
        for column in &mut cells {
            column.push(row.next().and_then(|cell| cell.parse().ok()));
        }
        if runs.len() == GROUP {
            group(writer.next_row_group()?, &mut runs, &mut cells)?;
        }
    }
    if !runs.is_empty() {
        group(writer.next_row_group()?, &mut runs, &mut cells)?;
    }
    writer.close().map(|_| ())
}

/// Writes the rows so far, and forgets them.
fn group<W: Write + Send>(
    mut group: SerializedRowGroupWriter<'_, W>,
    runs: &mut Vec<i64>,
    cells: &mut [Vec<Option<f64>>],
) -> Result<()> {
    let missing = || ParquetError::General("fewer columns than the schema has".to_owned());
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<Int64Type>().write_batch(runs, None, None)?;
    column.close()?;
    runs.clear();
    for cells in cells {
        let values: Vec<f64> = cells.iter().flatten().copied().collect();
        let present: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
        let mut column = group.next_column()?.ok_or_else(missing)?;
        column.typed::<DoubleType>().write_batch(&values, Some(&present), None)?;
        column.close()?;
        cells.clear();
    }
    group.close().map(|_| ())
}

/// A name that Parquet's text form of a schema takes: `servo.lead_time_constants_s[5]` is `servo_lead_time_constants_s_5`.
fn plain(name: &str) -> String {
    name.replace(['.', '['], "_").replace(']', "")
}
