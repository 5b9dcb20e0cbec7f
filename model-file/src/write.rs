//! Writing a model file, with the meaning and the unit of every key beside it.

use std::fmt::Write;

use gimbal_servo::Config;
use toml::Value;

use crate::fields::FIELDS;
use crate::read::{Preset, serialized};
use crate::tolerance::Tolerance;

/// Where the comments begin.
const COMMENT_COLUMN: usize = 60;

/// The text of a model file that reads back to the same parameters, every one of them written out.
#[must_use]
pub fn write(preset: Preset, config: &Config, tolerance: &Tolerance) -> String {
    let mut tables = serialized(config);
    tables.insert("tolerance".to_owned(), Value::Table(serialized(tolerance)));
    let mut text = format!("preset = \"{}\"\n", preset.name());
    let mut current = "";
    for (table, key, meaning) in FIELDS {
        let Some(value) = tables.get(table).and_then(|table| table.get(key)) else { continue };
        if table != current {
            let _ = writeln!(text, "\n[{table}]");
            current = table;
        }
        let entry = format!("{key} = {value}");
        let _ = writeln!(text, "{entry:COMMENT_COLUMN$} # {meaning}");
    }
    text
}

#[cfg(test)]
mod tests {
    use gimbal_servo::Config;

    use super::write;
    use crate::fields::FIELDS;
    use crate::read::serialized;
    use crate::{ModelFile, Preset, Tolerance};

    #[test]
    fn contract_every_field_has_a_meaning_and_a_home() {
        let mut tables = serialized(&Config::consistent());
        tables.insert("tolerance".to_owned(), toml::Value::Table(serialized(&Tolerance::default())));
        let mut there: Vec<(String, String)> = Vec::new();
        for (name, table) in &tables {
            there.extend(table.as_table().expect("a table").keys().map(|key| (name.clone(), key.clone())));
        }
        let mut told: Vec<(String, String)> =
            FIELDS.iter().map(|(table, key, _)| ((*table).to_owned(), (*key).to_owned())).collect();
        there.sort();
        told.sort();
        assert_eq!(there, told);
    }

    #[test]
    fn closed_form_what_is_written_reads_back_to_the_same_bits() {
        for preset in [Preset::Consistent, Preset::AsPrinted] {
            let mut config = preset.config();
            config.servo.gain_nm_per_rad_s *= 1.0 + f64::EPSILON;
            config.bearing.viscous_law = gimbal_servo::bearing::ViscousLaw::Metric;
            let tolerance = Tolerance { loop_gain: 0.5, ..Tolerance::with_default(0.01) };
            let text = write(preset, &config, &tolerance);
            let again = ModelFile::parse(&text, "again.toml").expect("reads");
            assert_eq!((again.preset, again.config, again.tolerance), (preset, config, tolerance));
            assert!(text.contains("[N m s/rad]"));
        }
    }
}
