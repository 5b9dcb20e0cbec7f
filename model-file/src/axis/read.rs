//! Reading and checking `[axis]`.

use std::path::Path;

use serde::Deserialize;

use super::effects::{hold, unknown};
use super::{AxisModel, Motion, Output, Quantity, Source};
use crate::error::{ModelFileError, Problem};
use crate::fields::nearest;
use crate::place::line_and_column;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    axis: AxisModel,
}

impl AxisModel {
    /// Reads a file, if it is one of a plain axis: one that has the table `[axis]`.
    ///
    /// # Errors
    /// What is wrong, where, and what would be right.
    pub fn open(path: &Path) -> Result<Option<Self>, ModelFileError> {
        // What cannot be read is told by the reader of the other kind of model.
        let Ok(text) = std::fs::read_to_string(path) else { return Ok(None) };
        Self::parse(&text, path)
    }

    /// Reads the text of a file; `file` is its name in messages.
    ///
    /// # Errors
    /// What is wrong, where, and what would be right.
    pub fn parse(text: &str, file: impl AsRef<Path>) -> Result<Option<Self>, ModelFileError> {
        let fail = |place: Option<usize>, problem: Problem| ModelFileError {
            file: file.as_ref().to_owned(),
            place: place.map(|offset| line_and_column(text, offset)),
            problem: Box::new(problem),
        };
        let is_axis = toml::de::DeTable::parse(text).is_ok_and(|root| root.get_ref().contains_key("axis"));
        if !is_axis {
            return Ok(None);
        }
        let mut model = toml::from_str::<File>(text)
            .map_err(|error| fail(error.span().map(|span| span.start), Problem::Impossible(told(error.message()))))?
            .axis;
        model.check().map_err(|(key, message)| fail(place(text, &key), Problem::Impossible(message)))?;
        hold(&mut model);
        Ok(Some(model))
    }

    /// Size of a column's values in the unit of the model.
    #[must_use]
    pub fn size(&self, source: &Source, quantity: Quantity) -> f64 {
        source.scale * quantity.size(&source.unit, self.motion, &self.effort_unit).unwrap_or(1.0)
    }

    /// Unit of a parameter: effort times s^`power` per position.
    #[must_use]
    pub fn parameter_unit(&self, power: u32) -> String {
        match (self.effort_unit.as_str(), self.motion, power) {
            ("N", Motion::Linear, 2) => "kg".to_owned(),
            ("N m", Motion::Rotary, 2) => "kg m2".to_owned(),
            (effort, motion, 0) => format!("{effort}/{}", motion.unit()),
            (effort, motion, 1) => format!("{effort} s/{}", motion.unit()),
            (effort, motion, power) => format!("{effort} s{power}/{}", motion.unit()),
        }
    }

    fn check(&self) -> Result<(), (String, String)> {
        let wrong = |key: &str, message: String| Err((key.to_owned(), format!("`axis.{key}` {message}")));
        if !(self.inertia.is_finite() && self.inertia > 0.0) {
            return wrong("inertia", format!("is {}; it must be above zero", self.inertia));
        }
        for (key, value) in [("viscous", self.viscous), ("coulomb", self.coulomb)] {
            if !(value.is_finite() && value >= 0.0) {
                return wrong(key, format!("is {value}; it must not be negative"));
            }
        }
        if self.effort_limit.is_some_and(|limit| !(limit > 0.0 && limit.is_finite())) {
            return wrong("effort_limit", "must be above zero".to_owned());
        }
        if self.band_hz.is_some_and(|band| !(band > 0.0 && band.is_finite())) {
            return wrong("band_hz", "must be above zero".to_owned());
        }
        if ![1.0, -1.0].contains(&self.load_direction) {
            return wrong("load_direction", format!("is {}; write 1 or -1", self.load_direction));
        }
        if let Some(message) = unknown(&self.known_good) {
            return wrong("known_good", message);
        }
        let columns = &self.columns;
        if columns.position.is_none() && columns.velocity.is_none() {
            return wrong("columns", "has neither `position` nor `velocity`; one of them is needed".to_owned());
        }
        let sources = [
            ("time", Some(&columns.time), Quantity::Time),
            ("position", columns.position.as_ref(), Quantity::Position),
            ("velocity", columns.velocity.as_ref(), Quantity::Rate),
            ("position_reference", columns.position_reference.as_ref(), Quantity::Position),
            ("velocity_reference", columns.velocity_reference.as_ref(), Quantity::Rate),
            ("effort", Some(&columns.effort), Quantity::Effort),
            ("command", columns.command.as_ref(), Quantity::Any),
        ];
        for (key, source, quantity) in sources {
            let Some(source) = source else { continue };
            if let Err(known) = quantity.size(&source.unit, self.motion, &self.effort_unit) {
                let has = match source.unit.as_str() {
                    "" => "has no `unit`".to_owned(),
                    unit => format!("has the unit \"{unit}\""),
                };
                return Err((key.to_owned(), format!("`axis.columns.{key}` {has}; {known}")));
            }
            if !(source.scale.is_finite() && source.scale != 0.0) {
                return Err((key.to_owned(), format!("`axis.columns.{key}` has a `scale` of {}", source.scale)));
            }
        }
        let tolerance = &self.tolerance;
        for (key, value) in
            [("inertia", tolerance.inertia), ("viscous", tolerance.viscous), ("coulomb", tolerance.coulomb)]
        {
            if !(0.0..=1.0).contains(&value) {
                let message = format!("`axis.tolerance.{key}` is {value}; it must lie between 0 and 1");
                return Err(("tolerance".to_owned(), message));
            }
        }
        if let Some(controller) = &self.controller
            && controller.output == Output::Command
            && columns.command.is_none()
        {
            return wrong("controller", "ends in `command`, which [axis.columns] does not name".to_owned());
        }
        Ok(())
    }
}

/// What serde says, on one line, with the nearest name where one is unknown.
fn told(message: &str) -> String {
    let message = message.lines().next().unwrap_or_default();
    let mut names = message.split('`').skip(1).step_by(2);
    match (message.starts_with("unknown field"), names.next()) {
        (true, Some(name)) => {
            let known: Vec<&str> = names.collect();
            format!("`{name}` is not a key here; the nearest known one is `{}`", nearest(name, known.into_iter()))
        }
        _ => message.to_owned(),
    }
}

/// Where a key stands.
fn place(text: &str, key: &str) -> Option<usize> {
    let starts = |line: &str| {
        let line = line.trim_start().trim_start_matches('[');
        let line = line.strip_prefix("axis.").unwrap_or(line);
        line.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with(['=', ']', '.']))
    };
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        if starts(line) {
            return Some(offset);
        }
        offset += line.len();
    }
    None
}
