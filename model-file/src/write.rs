//! Writing a model file, with the meaning and the unit of every key beside it.

use std::fmt::Write;

use gimbal_servo::Config;
use toml::Value;

use crate::effects::ModelEffect;
use crate::fields::FIELDS;
use crate::read::{Preset, serialized};
use crate::tolerance::Tolerance;

/// Where the comments begin.
const COMMENT_COLUMN: usize = 60;

/// The text of a model file that reads back to the same parameters, every one of them written out.
#[must_use]
pub fn write(preset: Preset, config: &Config, tolerance: &Tolerance) -> String {
    write_model(preset, config, tolerance, &[], &[], |_, _| None)
}

/// The same with effects and known parts; `remark` says more about a table and key, behind its meaning.
#[must_use]
pub fn write_model(
    preset: Preset,
    config: &Config,
    tolerance: &Tolerance,
    effects: &[ModelEffect],
    known_good: &[&str],
    remark: impl Fn(&str, &str) -> Option<String>,
) -> String {
    let mut tables = serialized(config);
    tables.insert("tolerance".to_owned(), Value::Table(serialized(tolerance)));
    let mut text = format!("preset = \"{}\"\n", preset.name());
    let mut current = String::new();
    let mut line = |table: &str, key: &str, value: &str, meaning: &str| {
        if table != current {
            let _ = writeln!(text, "\n[{table}]");
            table.clone_into(&mut current);
        }
        let more = remark(table, key).map(|more| format!("; {more}")).unwrap_or_default();
        let entry = format!("{key} = {value}");
        let _ = writeln!(text, "{entry:COMMENT_COLUMN$} # {meaning}{more}");
    };
    for (table, key, meaning) in FIELDS {
        let Some(value) = tables.get(table).and_then(|table| table.get(key)) else { continue };
        line(table, key, &value.to_string(), meaning);
    }
    for ModelEffect { effect, values } in effects {
        for (parameter, value) in effect.parameters().iter().zip(values) {
            let meaning = format!("block {} [{}]", effect.block(), parameter.unit);
            line(&format!("effects.{}", effect.name()), parameter.name, &Value::Float(*value).to_string(), &meaning);
        }
    }
    if !known_good.is_empty() {
        let names: Vec<String> = known_good.iter().map(|name| format!("\"{name}\"")).collect();
        line("known_good", "parts", &format!("[{}]", names.join(", ")), "as the model says");
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

    #[test]
    fn closed_form_effects_and_known_parts_read_back_to_the_same_bits() {
        let effects: Vec<crate::ModelEffect> = gimbal_plant::Effect::all()
            .map(|effect| crate::ModelEffect { effect, values: effect.typical() })
            .filter(|own| !crate::effects::fold(own.effect, &own.values, &mut Config::consistent()))
            .collect();
        let (preset, tolerance) = (Preset::Consistent, Tolerance::default());
        let remark = |table: &str, key: &str| (table == "effects.stribeck").then(|| format!("found: {key}"));
        let text = super::write_model(preset, &preset.config(), &tolerance, &effects, &["gyro", "time_skew"], remark);
        let again = ModelFile::parse(&text, "again.toml").expect("reads");
        assert_eq!(
            (again.config, again.effects, again.known_good),
            (preset.config(), effects, vec!["gyro", "time_skew"])
        );
        assert!(text.contains("found: excess_nm"), "{text}");
    }

    #[test]
    fn closed_form_an_effect_on_a_nominal_parameter_is_that_parameter() {
        let text = "[effects]\ngyro_damping = { relative_change = 0.1 }\nmass_unbalance = { change_x_kg_m = 1e-5, \
                    change_y_kg_m = 0 }\n";
        let model = ModelFile::parse(text, "m.toml").expect("reads");
        let mut expected = Config::consistent();
        expected.gyro.damping_nm_s_per_rad *= 1.1;
        expected.unbalance.x_kg_m += 1e-5;
        assert_eq!((model.config, model.effects.len()), (expected, 0));
    }
}
