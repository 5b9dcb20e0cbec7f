//! Scenarios: what flies, what goes wrong, and what must come out. The form stands in `docs/hil.md`.

mod library;

use std::fs;
use std::path::{Path, PathBuf};

use gimbal_model_file::{ModelFile, Preset};
use gimbal_plant::{Effect, Plant};
use gimbal_servo::{Config, estimator};
use serde::Deserialize;

pub use library::{SHIPPED, Shipped};

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

/// What moves the vehicle.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Profile {
    /// 1 g along y.
    Rest,
    /// The paper's 20 g along y for 5 s.
    Unbalance,
    /// The same with a rate of 0.1 rad/s that turns every 2 s.
    Friction,
    /// A swaying vehicle.
    Sway {
        /// Peak of the specific force along y [m/s2].
        accel_mps2: f64,
        /// Peak of the rate [rad/s].
        rate_radps: f64,
        /// Its frequency [Hz].
        frequency_hz: f64,
    },
    /// An external torque.
    Torque {
        /// Its size [N m].
        torque_nm: f64,
        /// Its end [s].
        off_s: f64,
    },
    /// A log; `rocket` is shipped, any other is a file beside the scenario.
    Log {
        /// Which.
        log: String,
    },
}

/// A part that can be taken out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// The bearings' friction.
    Friction,
    /// The mass unbalance.
    Unbalance,
}

/// White noise of the sensors, rms.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Noise {
    /// Pick-off [rad].
    pub gyro_angle_rad: f64,
    /// Step of the pick-off's quantisation [rad].
    pub gyro_step_rad: f64,
    /// Motor torque [N m].
    pub motor_torque_nm: f64,
    /// Specific force [m/s2].
    pub accel_mps2: f64,
    /// Rate [rad/s].
    pub rate_radps: f64,
}

impl Default for Noise {
    /// What the estimator's default sensors have.
    fn default() -> Self {
        let sensors = estimator::Sensors::default();
        Self {
            gyro_angle_rad: sensors.gyro_noise_rad,
            gyro_step_rad: sensors.gyro_step_rad,
            motor_torque_nm: sensors.motor_torque_noise_nm,
            accel_mps2: 0.01,
            rate_radps: 2e-4,
        }
    }
}

/// An effect of the platform.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EffectEntry {
    /// Its name.
    pub name: String,
    /// Values of its parameters; without them, typical ones.
    #[serde(default)]
    pub values: Vec<f64>,
}

/// A signal of the sensor frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Signal {
    /// Specific force along x.
    AccelXMps2,
    /// Specific force along y.
    AccelYMps2,
    /// Specific force along z.
    AccelZMps2,
    /// Vehicle rate.
    VehicleRateRadps,
    /// theta.
    GyroAngleRad,
    /// Motor torque.
    MotorTorqueNm,
}

/// How a sensor fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SensorFaultKind {
    /// It repeats its last reading.
    Stuck,
    /// It gives none: theta and the motor torque are marked, the others are not a number.
    Missing,
    /// It gives a value that is not a number.
    NotANumber,
    /// `value` is added.
    Bias,
    /// `value` is added once in 100 ticks.
    Spikes,
    /// It reads no more than `value`.
    Limited,
}

/// A sensor that fails for some time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorFault {
    /// Which.
    pub signal: Signal,
    /// How.
    pub kind: SensorFaultKind,
    /// From [s].
    pub from_s: f64,
    /// To [s].
    pub to_s: f64,
    /// How much.
    #[serde(default)]
    pub value: f64,
}

/// The way of a link fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Way {
    /// To the computer.
    Down,
    /// From the computer.
    Up,
}

/// What goes wrong on a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LinkFaultKind {
    /// A frame is lost.
    Drop,
    /// A frame comes twice.
    Repeat,
    /// A frame comes behind its successor.
    Reorder,
    /// A frame comes `amount` ticks late.
    Delay,
    /// One bit of a byte is turned; the rate is that of bytes.
    BitFlips,
    /// A byte becomes another; the rate is that of bytes.
    ByteErrors,
    /// The end of a frame is lost.
    Truncate,
    /// `amount` random bytes come before a frame.
    NoiseBurst,
    /// Nothing passes.
    Disconnect,
    /// `amount` frames of no use come with each.
    Flood,
}

/// A link fault for some time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkFault {
    /// What.
    pub kind: LinkFaultKind,
    /// Which way.
    pub way: Way,
    /// How often: probability for each frame, or for each byte.
    #[serde(default = "always")]
    pub rate: f64,
    /// How much.
    #[serde(default)]
    pub amount: u16,
    /// From [s].
    pub from_s: f64,
    /// To [s].
    pub to_s: f64,
}

fn always() -> f64 {
    1.0
}

/// What the bench does on the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    /// The computer loses everything, as after power-on.
    ResetBoard,
    /// The computer loses its state and runs on.
    ResetState,
    /// A `Run` with twice the watchdog's limit, which must be refused.
    RaiseLimit,
}

/// Something that the bench does at a time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// When [s].
    pub at_s: f64,
    /// What.
    pub action: Action,
}

/// What must come out: a measure with a limit, or a bit that must, or must never, be raised.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// The measure.
    pub measure: Option<String>,
    /// Largest value.
    pub most: Option<f64>,
    /// Least value.
    pub least: Option<f64>,
    /// A bit that must be raised.
    pub raised: Option<String>,
    /// The latest time for it [s].
    pub by_s: Option<f64>,
    /// A bit that must never be raised.
    pub never: Option<String>,
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

    /// The model of a preset or file, without what is taken out.
    pub(crate) fn axis(&self, name: &str) -> Result<(Config, estimator::Config), String> {
        let model = match name {
            "consistent" => ModelFile::preset(Preset::Consistent),
            "as-printed" => ModelFile::preset(Preset::AsPrinted),
            file => {
                let path = self.folder.as_deref().unwrap_or(Path::new(".")).join(file);
                ModelFile::open(&path).map_err(|error| error.to_string())?
            }
        };
        let mut config = model.config;
        for part in &self.without {
            config = match part {
                Part::Friction => config.without_friction(),
                Part::Unbalance => config.without_unbalance(),
            };
        }
        let tolerance = &model.tolerance;
        let mut settings = estimator::Config {
            tolerance: estimator::Tolerance {
                damping: tolerance.gyro_damping,
                float_inertia: tolerance.default_relative,
                angular_momentum: tolerance.angular_momentum,
                gimbal_inertia: tolerance.gimbal_inertia,
                stop_angle: tolerance.stop_angle,
                friction_level: tolerance.friction_level,
            },
            ..estimator::Config::default()
        };
        settings.sensors.gyro_noise_rad = self.noise.gyro_angle_rad.max(1e-9);
        settings.sensors.gyro_step_rad = self.noise.gyro_step_rad;
        settings.sensors.motor_torque_noise_nm = self.noise.motor_torque_nm;
        Ok((config, settings))
    }

    /// The platform with its effects.
    pub(crate) fn plant(&self) -> Result<Plant, String> {
        let (config, _) = self.axis(&self.model)?;
        // Far below the sensors' noise, and three times faster than the default.
        let mut plant = Plant::new(&config).map_err(|error| error.to_string())?.with_tolerance(1e-7);
        for entry in &self.effects {
            let effect = Effect::from_name(&entry.name).ok_or_else(|| {
                let names: Vec<&str> = Effect::all().map(Effect::name).collect();
                format!("`{}` is no effect; there are {}", entry.name, names.join(", "))
            })?;
            let values = if entry.values.is_empty() { effect.typical() } else { entry.values.clone() };
            plant = plant.with_effect(effect, &values).map_err(|error| error.to_string())?;
        }
        Ok(plant)
    }
}

impl Requirement {
    fn check(&self) -> Result<(), String> {
        let known = |name: &str, names: &[&str], what: &str| {
            if names.contains(&name) {
                Ok(())
            } else {
                Err(format!("`{name}` is no {what}; there are {}", names.join(", ")))
            }
        };
        match (&self.measure, &self.raised, &self.never) {
            (Some(measure), None, None) => {
                if self.most.is_none() && self.least.is_none() {
                    return Err(format!("the requirement on `{measure}` has no limit; give `most`, `least` or both"));
                }
                known(measure, &crate::judge::MEASURES, "measure")
            }
            (None, Some(bit), None) | (None, None, Some(bit)) => known(bit, &crate::judge::bit_names(), "bit"),
            _ => Err("a requirement has one of `measure`, `raised` and `never`".to_owned()),
        }
    }
}
