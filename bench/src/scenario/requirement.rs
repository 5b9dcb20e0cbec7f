//! What must come out.

use serde::Deserialize;

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

impl Requirement {
    pub(super) fn check(&self) -> Result<(), String> {
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
