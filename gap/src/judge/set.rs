//! Sets of effects in one another.

use crate::fit::{Fit, Search};

/// Whether a set holds all of another one.
pub(crate) fn holds(larger: &[&str], smaller: &[&str]) -> bool {
    smaller.iter().all(|effect| larger.contains(effect))
}

/// The same, and more.
pub(crate) fn is_part(smaller: &[&str], larger: &[&str]) -> bool {
    smaller.len() < larger.len() && holds(larger, smaller)
}

/// Fits of all the effects of a fit but one; the nominal parameters alone, where it has no other.
pub(super) fn with_one_less<'a>(search: &'a Search, fit: &'a Fit, effect: &'a str) -> impl Iterator<Item = &'a Fit> {
    let without = move |other: &&Fit| {
        other.effects.len() + 1 == fit.effects.len()
            && is_part(&other.effects, &fit.effects)
            && !other.effects.contains(&effect)
    };
    let alone = (fit.effects.len() == 1).then_some(&search.null);
    search.fits.iter().filter(without).chain(alone)
}
