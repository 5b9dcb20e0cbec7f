//! What is told: `gap.json`, `gap.html`, and a few lines for the terminal.

mod html;
mod json;
mod picture;
mod pooled;
mod text;

pub use html::html;
pub use json::json;
pub use pooled::pooled;
pub use text::text;

/// Parts of a page, for reports of other kinds.
pub(crate) mod page {
    pub(crate) use super::html::{STYLE, escaped};
    pub(crate) use super::picture::{Line, SCRIPT, plot};
}
