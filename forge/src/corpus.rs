//! A corpus of logs: which kinds in which shares, and one log after the other from a seed.

mod bench;
mod case;
mod chosen;
mod drift;
mod logged;
mod setting;
mod sizing;
mod text;

use serde::{Deserialize, Serialize};

use crate::draw::{Draw, Seed};
use crate::excitation::{Excitation, Rocket};
use crate::sensors::Noise;

pub use drift::Drift;

/// What was put into a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, PartialOrd, Ord)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Nothing but noise and drift inside tolerance.
    Nothing,
    /// One effect of the contract's table.
    One,
    /// Two of them.
    Two,
    /// Three of them.
    Three,
    /// One effect that the table does not have.
    Beyond,
}

impl Kind {
    /// All kinds, in the order of their shares.
    pub const ALL: [Self; 5] = [Self::Nothing, Self::One, Self::Two, Self::Three, Self::Beyond];

    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::One => "one",
            Self::Two => "two",
            Self::Three => "three",
            Self::Beyond => "beyond",
        }
    }

    fn effects(self) -> usize {
        match self {
            Self::Nothing => 0,
            Self::One | Self::Beyond => 1,
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

/// How a corpus is made.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// Number of logs.
    pub logs: usize,
    /// Everything random comes from it.
    pub seed: Seed,
    /// Least and largest length of a log [s].
    pub length_s: (f64, f64),
    /// The real flight, if there.
    pub rocket: Option<Rocket>,
    /// Shares of nothing, one, two, three and beyond [percent].
    pub shares: [usize; 5],
    /// Least and largest size of an effect over the detectable one.
    pub multiples: (f64, f64),
}

/// Shares of a scoring corpus [percent].
pub const SHARES: [usize; 5] = [20, 40, 20, 5, 15];
/// Sizes over the detectable one in a scoring corpus.
pub const MULTIPLES: (f64, f64) = (0.5, 10.0);

impl Recipe {
    /// The recipe of a scoring corpus.
    #[must_use]
    pub fn scoring(logs: usize, seed: Seed, length_s: (f64, f64), rocket: Option<Rocket>) -> Self {
        Self { logs, seed, length_s, rocket, shares: SHARES, multiples: MULTIPLES }
    }
}

/// One effect of a log, as it was put in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AnswerEffect {
    /// Name.
    pub name: String,
    /// Block, `beyond` for effects that the table does not have.
    pub block: String,
    /// Parameters, sizes first.
    pub parameters: Vec<crate::effects::Parameter>,
    /// Size in the effect's own unit.
    pub size: f64,
    /// Size that would have d = 5 alone.
    pub detectable_size: f64,
    /// Size over the detectable one.
    pub multiple: f64,
    /// d alone.
    pub d: f64,
    /// d with the other effects of the log free to take from it.
    pub d_beside_others: f64,
    /// d with every effect of the table (its own aside) free to take from it, all at once.
    pub d_beyond_library: f64,
    /// Effects of the table that leave less than d = 5 of it: nobody can tell them apart on this log.
    pub equivalents: Vec<String>,
}

/// Residuals of one channel without its first second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SignalGap {
    /// Column.
    pub name: String,
    /// Nominal model against the log [rms].
    pub before: f64,
    /// True model against the log, both driven by what was logged [rms].
    pub best: f64,
}

/// The answer to one log.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Answer {
    /// Name of the log, without ending.
    pub log: String,
    /// What was put in.
    pub kind: Kind,
    /// Motion.
    pub excitation: Excitation,
    /// Length [s].
    pub length_s: f64,
    /// Whether the record starts while the platform already moves.
    pub mid_run: bool,
    /// Preset of the nominal model.
    pub preset: String,
    /// Optional columns that the log has.
    pub columns: Vec<String>,
    /// Noise.
    pub noise: Noise,
    /// Relative drift of each nominal parameter.
    pub drift: Drift,
    /// Effects; empty for nothing.
    pub effects: Vec<AnswerEffect>,
    /// Gaps by channel.
    pub signals: Vec<SignalGap>,
}

/// One log as it is handed out, and its answer.
#[derive(Debug, Clone)]
pub struct Case {
    /// The log as CSV.
    pub csv: String,
    /// The nominal model as TOML.
    pub model: String,
    /// What was put in.
    pub answer: Answer,
}

/// The kind of every log, in the order of the logs. The counts are the shares, rounded; the rest is of the commonest
/// kind.
#[must_use]
pub fn kinds(recipe: &Recipe) -> Vec<Kind> {
    let logs = recipe.logs;
    let largest = recipe.shares.iter().copied().max().unwrap_or(0);
    let common = Kind::ALL[recipe.shares.iter().position(|share| *share == largest).unwrap_or(0)];
    let mut kinds = Vec::with_capacity(logs);
    for (kind, percent) in Kind::ALL.into_iter().zip(recipe.shares) {
        if kind != common {
            kinds.extend(std::iter::repeat_n(kind, (logs * percent + 50) / 100));
        }
    }
    kinds.truncate(logs);
    kinds.resize(logs, common);
    Draw::new(&recipe.seed, 0).shuffle(&mut kinds);
    kinds
}

/// Name of a log.
#[must_use]
pub fn log_name(index: usize) -> String {
    format!("{:05}", index + 1)
}

/// Makes one log; the same recipe and index give the same bytes.
#[must_use]
pub fn make(recipe: &Recipe, kind: Kind, index: usize) -> Case {
    case::make(recipe, kind, index)
}
