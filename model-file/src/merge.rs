//! Overrides onto a preset, key by key, each checked against the value that it replaces.

use std::ops::Range;

use gimbal_servo::Config;
use serde::Deserialize;
use toml::Value;
use toml::de::{DeTable, DeValue};

use crate::error::Problem;
use crate::fields::nearest;
use crate::place::Places;

/// A problem and where it is.
pub(crate) type Wrong = (Range<usize>, Problem);

/// Sets the keys of one table; `deserialize` says whether the table still means something.
pub(crate) fn table(
    name: &str,
    base: &mut toml::Table,
    overrides: &DeTable,
    places: &mut Places,
    deserialize: impl Fn(&toml::Table) -> Result<(), String>,
) -> Result<(), Wrong> {
    let mut entries: Vec<_> = overrides.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    for (key, value) in entries {
        let field = key.get_ref().as_ref();
        let Some(old) = base.get(field).cloned() else {
            let nearest = nearest(field, base.keys().map(String::as_str));
            return Err((key.span(), Problem::UnknownKey { table: name.to_owned(), name: field.to_owned(), nearest }));
        };
        let full_name = format!("{name}.{field}");
        let new = like(&old, value.get_ref()).ok_or_else(|| {
            let (found, expected) = (described(value.get_ref()), wanted(&old));
            (value.span(), Problem::WrongType { name: full_name.clone(), found, expected })
        })?;
        base.insert(field.to_owned(), new);
        // What is left are names of variants and ranges of integers, which only the struct knows.
        deserialize(base).map_err(|message| {
            let message = message.lines().next().unwrap_or_default().to_owned();
            (value.span(), Problem::Impossible(format!("`{full_name}`: {message}")))
        })?;
        places.push((full_name, value.span()));
    }
    Ok(())
}

/// The configuration that a table of tables means.
pub(crate) fn config(tables: &toml::Table) -> Result<Config, String> {
    Config::deserialize(Value::Table(tables.clone())).map_err(|error| error.message().to_owned())
}

/// The new value in the type of the old one.
fn like(old: &Value, new: &DeValue) -> Option<Value> {
    match (old, new) {
        (Value::Float(_), DeValue::Float(number)) => {
            number.as_str().replace('_', "").parse().ok().filter(|number: &f64| number.is_finite()).map(Value::Float)
        }
        (Value::Float(_), DeValue::Integer(_)) => match like(&Value::Integer(0), new) {
            #[allow(clippy::cast_precision_loss, reason = "a whole number stands for a float here")]
            Some(Value::Integer(number)) => Some(Value::Float(number as f64)),
            _ => None,
        },
        (Value::Integer(_), DeValue::Integer(number)) => {
            i64::from_str_radix(number.as_str(), number.radix()).ok().map(Value::Integer)
        }
        (Value::Boolean(_), DeValue::Boolean(flag)) => Some(Value::Boolean(*flag)),
        (Value::String(_), DeValue::String(text)) => Some(Value::String(text.to_string())),
        (Value::Array(old), DeValue::Array(new)) if old.len() == new.len() => old
            .iter()
            .zip(new.iter())
            .map(|(old, new)| like(old, new.get_ref()))
            .collect::<Option<_>>()
            .map(Value::Array),
        _ => None,
    }
}

/// What stands in the file.
fn described(value: &DeValue) -> String {
    match value {
        DeValue::String(text) => format!("the text \"{}\"", text.escape_debug()),
        DeValue::Integer(number) => format!("the integer {}", number.as_str()),
        DeValue::Float(number) => format!("the number {}", number.as_str()),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(entries) => match entries.iter().find(|entry| !is_number(entry.get_ref())) {
            Some(entry) => format!("an array with {}", described(entry.get_ref())),
            None => format!("an array of {}", entries.len()),
        },
        DeValue::Table(_) => "a table".to_owned(),
    }
}

fn is_number(value: &DeValue) -> bool {
    matches!(value, DeValue::Integer(_) | DeValue::Float(_))
}

/// What would be right in place of the old value.
fn wanted(old: &Value) -> String {
    match old {
        Value::Float(number) => format!("a finite number such as {number}"),
        Value::Integer(number) => format!("an integer such as {number}"),
        Value::Boolean(_) => "true or false".to_owned(),
        Value::String(text) => format!("a text such as \"{text}\""),
        Value::Array(entries) => format!("an array of {} finite numbers", entries.len()),
        Value::Datetime(_) | Value::Table(_) => "nothing".to_owned(),
    }
}
