//! A gap report (`gap.json`, schema `gimbal-gap/1`) as far as the score needs it; other keys are left alone.

use serde::{Deserialize, Serialize};

/// Name of the form.
pub const SCHEMA: &str = "gimbal-gap/1";

/// What the diagnosis says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing beyond noise and tolerance.
    NoGap,
    /// One set of effects, and the residual passes.
    Explained,
    /// Effects found, the residual fails.
    PartlyExplained,
    /// A gap and no effect for it.
    Unexplained,
    /// Several sets that this log does not tell apart.
    CannotTell,
}

/// A parameter as reported.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Standard deviation.
    #[serde(default)]
    pub std: Option<f64>,
    /// Unit.
    #[serde(default)]
    pub unit: String,
}

/// An effect as reported.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Effect {
    /// Name.
    pub name: String,
    /// Marginal probability.
    pub probability: f64,
    /// Parameters, in the order of the contract.
    #[serde(default)]
    pub parameters: Vec<Parameter>,
}

/// Another set of effects.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alternative {
    /// Names.
    pub effects: Vec<String>,
    /// Probability of the set.
    pub probability: f64,
}

/// How far one signal's residual shrinks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shrunk {
    /// Column.
    pub name: String,
    /// Residual of the nominal model [rms].
    #[serde(default)]
    pub before: Option<f64>,
    /// Residual of the mended model [rms].
    #[serde(default)]
    pub after: Option<f64>,
    /// [rms]
    #[serde(default)]
    pub noise_floor: Option<f64>,
    /// In percent of what can be closed.
    #[serde(default)]
    pub reduction_percent: Option<f64>,
    /// 95 % interval of the same.
    #[serde(default)]
    pub ci95_percent: Option<[f64; 2]>,
}

/// How far the residuals shrink.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Shrink {
    /// By signal.
    #[serde(default)]
    pub signals: Vec<Shrunk>,
}

/// The report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: String,
    /// What the diagnosis says.
    pub verdict: Verdict,
    /// Effects found.
    #[serde(default)]
    pub effects: Vec<Effect>,
    /// Probability that the cause is none of the known effects.
    #[serde(default)]
    pub unknown_probability: f64,
    /// Other sets.
    #[serde(default)]
    pub alternatives: Vec<Alternative>,
    /// How far the residuals shrink.
    #[serde(default)]
    pub shrink: Option<Shrink>,
}

impl Report {
    /// Reads a report.
    ///
    /// # Errors
    /// It does not have the form.
    pub fn parse(bytes: &[u8]) -> Result<Self, String> {
        let report: Self = serde_json::from_slice(bytes).map_err(|why| why.to_string())?;
        if report.schema == SCHEMA { Ok(report) } else { Err(format!("schema `{}` is not `{SCHEMA}`", report.schema)) }
    }

    /// Names of the effects found.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.effects.iter().map(|effect| effect.name.as_str()).collect()
    }

    /// Whether the report says that the log does not serve, and names no cause.
    #[must_use]
    pub fn refuses(&self) -> bool {
        self.verdict == Verdict::CannotTell && self.effects.is_empty() && self.alternatives.is_empty()
    }

    /// Probability of the set that is reported: what alternatives and unknown leave.
    #[must_use]
    pub fn set_probability(&self) -> f64 {
        let others: f64 = self.alternatives.iter().map(|other| other.probability).sum();
        (1.0 - others - self.unknown_probability).clamp(0.0, 1.0)
    }

    /// All sets with their probabilities, the reported one first.
    #[must_use]
    pub fn sets(&self) -> Vec<(Vec<&str>, f64)> {
        let mut sets = vec![(self.names(), self.set_probability())];
        sets.extend(
            self.alternatives
                .iter()
                .map(|other| (other.effects.iter().map(String::as_str).collect(), other.probability)),
        );
        sets
    }

    /// Names by marginal probability, the likeliest first; `unknown` and `no_gap` stand among them.
    #[must_use]
    pub fn ranking(&self) -> Vec<(String, f64)> {
        let mut ranking: Vec<(String, f64)> =
            self.effects.iter().map(|effect| (effect.name.clone(), effect.probability)).collect();
        for other in &self.alternatives {
            for name in &other.effects {
                match ranking.iter_mut().find(|(there, _)| there == name) {
                    // a reported effect's probability is marginal already
                    Some(_) if self.effects.iter().any(|effect| effect.name == *name) => {}
                    Some((_, probability)) => *probability += other.probability,
                    None => ranking.push((name.clone(), other.probability)),
                }
            }
        }
        ranking.push(("unknown".to_owned(), self.unknown_probability));
        if self.effects.is_empty() {
            let nothing = if self.verdict == Verdict::NoGap { "no_gap" } else { "unknown" };
            match ranking.iter_mut().find(|(there, _)| there == nothing) {
                Some((_, probability)) => *probability = probability.max(self.set_probability()),
                None => ranking.push((nothing.to_owned(), self.set_probability())),
            }
        }
        ranking.sort_by(|a, b| b.1.total_cmp(&a.1));
        ranking
    }
}
