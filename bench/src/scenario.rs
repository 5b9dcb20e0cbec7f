//! Scenarios: what flies, what goes wrong, and what must come out. The form stands in `docs/hil.md`.

mod library;
mod linking;
mod model;
mod motion;
mod requirement;
mod sensing;

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

pub use library::{SHIPPED, Shipped};
pub use linking::{Action, Event, LinkFault, LinkFaultKind, Way};
pub use motion::{EffectEntry, Part, Profile};
pub use requirement::Requirement;
pub use sensing::{Noise, SensorFault, SensorFaultKind, Signal};

/// A scenario as its file says.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Its name; that of its file.
    #[serde(skip)]
    pub name: String,
    /// One sentence.
    pub about: String,
    /// How long [s].
    pub duration_s: f64,
    /// Seed of every random stream.
    #[serde(default)]
    pub seed: u64,
    /// What moves the vehicle.
    pub profile: Profile,
    /// What is taken out of platform and model.
    #[serde(default)]
    pub without: Vec<Part>,
    /// The platform's model, which the bench expects on the computer: a preset or a model file.
    #[serde(default = "consistent")]
    pub model: String,
    /// What is loaded instead, by mistake.
    pub loaded: Option<String>,
    /// Ticks without a frame that the watchdog waits; 0: the computer's limit.
    #[serde(default)]
    pub watchdog_ticks: u16,
    /// Noise of the sensors.
    #[serde(default)]
    pub noise: Noise,
    /// What the platform does beyond its model.
    #[serde(default, rename = "effect")]
    pub effects: Vec<EffectEntry>,
    /// What goes wrong with sensors.
    #[serde(default, rename = "sensor_fault")]
    pub sensor_faults: Vec<SensorFault>,
    /// What goes wrong on the link.
    #[serde(default, rename = "link_fault")]
    pub link_faults: Vec<LinkFault>,
    /// What the bench does on the way.
    #[serde(default, rename = "event")]
    pub events: Vec<Event>,
    /// What must come out.
    #[serde(default, rename = "require")]
    pub requirements: Vec<Requirement>,
    /// The text of the file.
    #[serde(skip)]
    pub text: String,
    #[serde(skip)]
    pub(crate) folder: Option<PathBuf>,
}

fn consistent() -> String {
    "consistent".to_owned()
}

/// Why a scenario cannot be read: what, where, and what would be right.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// No such file, and no shipped scenario of that name.
    #[error("{0}: no such file, and no shipped scenario; there are {names}", names = SHIPPED.iter().map(|s| s.name).collect::<Vec<_>>().join(", "))]
    Unknown(String),
    /// The file cannot be read.
    #[error("{0}: cannot be read: {1}")]
    Unreadable(String, std::io::Error),
    /// The text is no scenario.
    #[error("{file}: line {line}, column {column}: {message}")]
    Text {
        /// File or name.
        file: String,
        /// Line from 1.
        line: usize,
        /// Column from 1.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// A value has no meaning.
    #[error("{file}: {message}")]
    Value {
        /// File or name.
        file: String,
        /// What is wrong, and what would be right.
        message: String,
    },
}

impl Scenario {
    /// A shipped scenario by its name, or one from a file.
    ///
    /// # Errors
    /// What is wrong, where, and what would be right.
    pub fn open(name: &str) -> Result<Self, ScenarioError> {
        if let Some(shipped) = SHIPPED.iter().find(|shipped| shipped.name == name) {
            return Self::parse(shipped.text, shipped.name, None);
        }
        let path = Path::new(name);
        if !path.exists() {
            return Err(ScenarioError::Unknown(name.to_owned()));
        }
        let text = fs::read_to_string(path).map_err(|error| ScenarioError::Unreadable(name.to_owned(), error))?;
        Self::parse(&text, name, Some(path.parent().unwrap_or(Path::new(".")).to_owned()))
    }

    /// Reads the text of a scenario.
    ///
    /// # Errors
    /// What is wrong, where, and what would be right.
    pub fn parse(text: &str, file: &str, folder: Option<PathBuf>) -> Result<Self, ScenarioError> {
        let mut scenario: Self = toml::from_str(text).map_err(|error| {
            let before = &text[..error.span().map_or(0, |span| span.start.min(text.len()))];
            let line = before.matches('\n').count() + 1;
            let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
            let message = error.message().lines().collect::<Vec<_>>().join("; ");
            ScenarioError::Text { file: file.to_owned(), line, column, message }
        })?;
        scenario.name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        text.clone_into(&mut scenario.text);
        scenario.folder = folder;
        scenario.check().map_err(|message| ScenarioError::Value { file: file.to_owned(), message })?;
        Ok(scenario)
    }

    fn check(&self) -> Result<(), String> {
        if !(0.1..=86_400.0).contains(&self.duration_s) {
            return Err(format!("`duration_s` is {}; it must lie between 0.1 and 86400", self.duration_s));
        }
        let spans = self.sensor_faults.iter().map(|fault| ("sensor_fault", fault.from_s, fault.to_s));
        for (name, from_s, to_s) in spans.chain(self.link_faults.iter().map(|f| ("link_fault", f.from_s, f.to_s))) {
            if !(from_s.is_finite() && to_s.is_finite() && 0.0 <= from_s && from_s < to_s) {
                return Err(format!("a {name} lasts from {from_s} to {to_s} s; `from_s` must come before `to_s`"));
            }
        }
        for fault in &self.link_faults {
            if !(0.0..=1.0).contains(&fault.rate) {
                return Err(format!("`rate` of a link_fault is {}; it must lie between 0 and 1", fault.rate));
            }
            if fault.kind == LinkFaultKind::Flood && fault.way == Way::Up {
                return Err("a flood goes `way = \"down\"`".to_owned());
            }
        }
        for requirement in &self.requirements {
            requirement.check()?;
        }
        self.axis(&self.model)?;
        self.axis(self.loaded.as_ref().unwrap_or(&self.model))?;
        self.plant().map(drop)
    }
}
