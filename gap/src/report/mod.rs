//! What is told: `gap.json`, `gap.html`, and a few lines for the terminal.

mod html;
mod json;
mod picture;
mod text;

pub use html::html;
pub use json::json;
pub use text::text;
