//! Reading a model file.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use gimbal_servo::{BuildError, Config};
use serde::Deserialize;
use toml::Value;
use toml::de::{DeTable, DeValue};

use crate::effects::{self, ModelEffect};
use crate::error::{ModelFileError, Problem};
use crate::fields::{home, nearest};
use crate::known_good;
use crate::merge::{self, Wrong};
use crate::place::{Places, line_and_column};
use crate::tolerance::Tolerance;

/// The parameter set that a file builds on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preset {
    /// T5 = 0.168 s, which meets the paper's own results.
    #[default]
    Consistent,
    /// Every coefficient as printed.
    AsPrinted,
}

impl Preset {
    /// Name in the file.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Consistent => "consistent",
            Self::AsPrinted => "as-printed",
        }
    }

    /// The parameters.
    #[must_use]
    pub fn config(self) -> Config {
        match self {
            Self::Consistent => Config::consistent(),
            Self::AsPrinted => Config::as_printed(),
        }
    }
}

/// A model, and the file that it came from.
#[derive(Debug, Clone)]
pub struct ModelFile {
    /// What the file builds on.
    pub preset: Preset,
    /// The parameters, each checked by itself.
    pub config: Config,
    /// How well they are known.
    pub tolerance: Tolerance,
    /// What the axis does beside them; changes of a nominal parameter are in `config` instead.
    pub effects: Vec<ModelEffect>,
    /// Parts and effects that are known to be as the model says.
    pub known_good: Vec<&'static str>,
    file: PathBuf,
    text: String,
    places: Places,
}

impl Default for ModelFile {
    /// The default preset without a file.
    fn default() -> Self {
        Self::preset(Preset::default())
    }
}

impl ModelFile {
    /// A preset without a file.
    #[must_use]
    pub fn preset(preset: Preset) -> Self {
        Self {
            preset,
            config: preset.config(),
            tolerance: Tolerance::default(),
            effects: Vec::new(),
            known_good: Vec::new(),
            file: PathBuf::from(preset.name()),
            text: String::new(),
            places: Places::new(),
        }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong, where, and what would be right.
    pub fn open(path: &Path) -> Result<Self, ModelFileError> {
        let fail = |problem| ModelFileError { file: path.to_owned(), place: None, problem: Box::new(problem) };
        let bytes = fs::read(path).map_err(|error| fail(error.into()))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = String::from_utf8_lossy(&error.as_bytes()[..error.utf8_error().valid_up_to()]).into_owned();
            ModelFileError { place: Some(line_and_column(&valid, valid.len())), ..fail(Problem::NotUtf8) }
        })?;
        Self::parse(&text, path)
    }

    /// Reads the text of a file; `file` is its name in messages.
    ///
    /// # Errors
    /// What is wrong, where, and what would be right.
    pub fn parse(text: &str, file: impl Into<PathBuf>) -> Result<Self, ModelFileError> {
        let mut model = Self { file: file.into(), text: text.to_owned(), ..Self::preset(Preset::default()) };
        model.take(text).map_err(|(span, problem)| model.error(Some(span), problem))?;
        model.config.check().map_err(|error| model.locate(&error))?;
        for (name, value) in model.tolerance.entries() {
            if !(0.0..=1.0).contains(&value) {
                let name = format!("tolerance.{name}");
                let message = format!("`{name}` is {value}; it must lie between 0 and 1");
                return Err(model.error(model.span(&name), Problem::Impossible(message)));
            }
        }
        Ok(model)
    }

    /// What a law that cannot be built means in terms of this file: the key named, where it stands here.
    #[must_use]
    pub fn locate(&self, error: &BuildError) -> ModelFileError {
        let message = error.to_string();
        if matches!(error, BuildError::UnstablePole { .. }) {
            return self.unstable(&message);
        }
        let field = message.split('`').nth(1).unwrap_or_default();
        self.error(self.span(field), Problem::Impossible(message))
    }

    /// An unstable loop, with the key of this file that makes it so, if one alone does.
    fn unstable(&self, message: &str) -> ModelFileError {
        let in_loop = |name: &&str| name.starts_with("servo.") || name.starts_with("gyro.");
        let changed: Vec<&str> = self.places.iter().map(|(name, _)| name.as_str()).filter(in_loop).collect();
        let stable_without = |name: &&str| self.without(name).is_some_and(|config| config.build::<f32>().is_ok());
        let preset = self.preset.name();
        if let Some(&cause) = changed.iter().find(|name| stable_without(name)) {
            let told = format!("{message}; with `{cause}` of the preset {preset} it is stable");
            return self.error(self.span(cause), Problem::Impossible(told));
        }
        let cause = if changed.is_empty() {
            String::new()
        } else {
            let names: Vec<String> = changed.iter().map(|name| format!("`{name}`")).collect();
            format!(
                "; what differs from the preset {preset}, and no single one of them alone does it: {}",
                names.join(", ")
            )
        };
        self.error(None, Problem::Impossible(format!("{message}{cause}")))
    }

    /// The parameters with one of this file's left as in the preset.
    fn without(&self, name: &str) -> Option<Config> {
        let (table, key) = name.split_once('.')?;
        let mut tables = serialized(&self.config);
        let base = serialized(&self.preset.config()).get(table)?.get(key)?.clone();
        tables.get_mut(table)?.as_table_mut()?.insert(key.to_owned(), base);
        merge::config(&tables).ok()
    }

    /// Where the value of `table.key` stands in the file.
    fn span(&self, name: &str) -> Option<Range<usize>> {
        self.places.iter().find(|(place, _)| place == name).map(|(_, span)| span.clone())
    }

    fn error(&self, span: Option<Range<usize>>, problem: Problem) -> ModelFileError {
        let place = span.map(|span| line_and_column(&self.text, span.start));
        ModelFileError { file: self.file.clone(), place, problem: Box::new(problem) }
    }

    fn take(&mut self, text: &str) -> Result<(), Wrong> {
        let root = DeTable::parse(text).map_err(|error| {
            let message = error.message().lines().collect::<Vec<_>>().join("; ");
            (error.span().unwrap_or(0..0), Problem::Syntax(message))
        })?;
        let mut entries: Vec<_> = root.get_ref().iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        if let Some((_, value)) = entries.iter().find(|(key, _)| key.get_ref() == "preset") {
            self.preset = preset(value.get_ref()).map_err(|problem| (value.span(), problem))?;
        }
        let mut tables = serialized(&self.preset.config());
        for (key, value) in entries.into_iter().filter(|(key, _)| key.get_ref() != "preset") {
            let name = key.get_ref().as_ref();
            let DeValue::Table(overrides) = value.get_ref() else { return Err((key.span(), homeless(name, &tables))) };
            if name == "tolerance" {
                self.take_tolerance(overrides)?;
                continue;
            }
            if name == "effects" {
                self.effects = effects::read(overrides, &mut self.places)?;
                continue;
            }
            if name == "known_good" {
                self.known_good = known_good::read(overrides)?;
                continue;
            }
            let Some(base) = tables.get(name).and_then(Value::as_table) else {
                return Err((key.span(), unknown_table(name, &tables)));
            };
            let mut merged = base.clone();
            merge::table(name, &mut merged, overrides, &mut self.places, |table| {
                let mut all = tables.clone();
                all.insert(name.to_owned(), Value::Table(table.clone()));
                merge::config(&all).map(|_| ())
            })?;
            tables.insert(name.to_owned(), Value::Table(merged));
        }
        self.config = merge::config(&tables).map_err(|message| (0..0, Problem::Impossible(message)))?;
        let config = &mut self.config;
        self.effects.retain(|entry| !effects::fold(entry.effect, &entry.values, config));
        Ok(())
    }

    /// The parameters, for what cannot take effects.
    ///
    /// # Errors
    /// The first effect of the file, which `user` would leave out in silence.
    pub fn without_effects(&self, user: &str) -> Result<&Config, ModelFileError> {
        let Some(first) = self.effects.first() else { return Ok(&self.config) };
        let name = format!("effects.{}", first.effect.name());
        let span = first.effect.parameters().first().and_then(|own| self.span(&format!("{name}.{}", own.name)));
        Err(self.error(span, Problem::Impossible(format!("{user} does not take `{name}`; take it out of the file"))))
    }

    fn take_tolerance(&mut self, overrides: &DeTable) -> Result<(), Wrong> {
        let read = |table: &toml::Table| {
            Tolerance::deserialize(Value::Table(table.clone())).map_err(|error| error.message().to_owned())
        };
        // First pass for the default, which the second one spreads.
        let mut table = serialized(&Tolerance::default());
        merge::table("tolerance", &mut table, overrides, &mut Places::new(), |table| read(table).map(|_| ()))?;
        let first = read(&table).map_err(|message| (0..0, Problem::Impossible(message)))?;
        let mut table = serialized(&Tolerance::with_default(first.default_relative));
        merge::table("tolerance", &mut table, overrides, &mut self.places, |table| read(table).map(|_| ()))?;
        self.tolerance = read(&table).map_err(|message| (0..0, Problem::Impossible(message)))?;
        Ok(())
    }
}

fn preset(value: &DeValue) -> Result<Preset, Problem> {
    match value {
        DeValue::String(name) if name == Preset::Consistent.name() => Ok(Preset::Consistent),
        DeValue::String(name) if name == Preset::AsPrinted.name() => Ok(Preset::AsPrinted),
        DeValue::String(name) => Err(Problem::Preset(name.escape_debug().to_string())),
        _ => Err(Problem::Preset("preset".to_owned())),
    }
}

/// Tables beside those of the parameters.
const TABLES: [&str; 3] = ["tolerance", "effects", "known_good"];

fn unknown_table(name: &str, tables: &toml::Table) -> Problem {
    if name == "axis" {
        return Problem::PlainAxis;
    }
    let known = tables.keys().map(String::as_str).chain(TABLES);
    Problem::UnknownTable { name: name.to_owned(), nearest: nearest(name, known) }
}

fn homeless(name: &str, tables: &toml::Table) -> Problem {
    let hint = match home(name) {
        Some(table) => format!("write it below [{table}]"),
        None if tables.contains_key(name) || TABLES.contains(&name) => format!("write [{name}] and its keys below it"),
        None => {
            let key = nearest(name, crate::fields::FIELDS.iter().map(|(_, key, _)| *key).chain(["preset"]));
            match home(&key) {
                Some(table) => format!("the nearest known key is `{key}` of [{table}]"),
                None => "the nearest known key is `preset`".to_owned(),
            }
        }
    };
    Problem::Homeless { name: name.to_owned(), hint }
}

/// A struct of numbers as the table that it is in a file.
pub(crate) fn serialized(fields: &impl serde::Serialize) -> toml::Table {
    match Value::try_from(fields) {
        Ok(Value::Table(table)) => table,
        _ => toml::Table::new(),
    }
}
