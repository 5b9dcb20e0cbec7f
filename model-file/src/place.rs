//! Offsets in a text as lines and columns.

use std::ops::Range;

/// Line and column of an offset, counted from 1; columns count characters.
pub(crate) fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |end| end + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// Keys that stand in a file: `table.key` and where.
pub(crate) type Places = Vec<(String, Range<usize>)>;

#[cfg(test)]
mod tests {
    use super::line_and_column;

    #[test]
    fn closed_form_lines_and_columns_count_from_one() {
        assert_eq!(line_and_column("", 0), (1, 1));
        assert_eq!(line_and_column("a\nµb", 4), (2, 2));
        assert_eq!(line_and_column("a\nb\n", 4), (3, 1));
    }
}
