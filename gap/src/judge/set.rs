//! Sets of effects in one another.

/// Whether a set holds all of another one.
pub(crate) fn holds(larger: &[&str], smaller: &[&str]) -> bool {
    smaller.iter().all(|effect| larger.contains(effect))
}

/// The same, and more.
pub(crate) fn is_part(smaller: &[&str], larger: &[&str]) -> bool {
    smaller.len() < larger.len() && holds(larger, smaller)
}
