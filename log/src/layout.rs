//! Which column of a file is which.

use crate::Column;

/// How a number of the file becomes SI: `value * factor + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// SI units per unit of the file, with the sign.
    pub factor: f64,
    /// Added after the factor, in SI units.
    pub offset: f64,
}

impl Scale {
    /// SI already.
    pub const SI: Self = Self { factor: 1.0, offset: 0.0 };

    /// The number in SI units.
    #[must_use]
    pub fn apply(self, value: f64) -> f64 {
        value * self.factor + self.offset
    }
}

/// The columns of one file.
#[derive(Debug, Clone)]
pub struct Layout {
    names: Vec<String>,
    roles: Vec<Option<Column>>,
    units: Vec<String>,
    /// Set only where a column is not SI already, so that a log keeps its bits.
    scales: [Option<Scale>; Column::COUNT],
}

impl Layout {
    /// A file in which every column is extra.
    #[must_use]
    pub fn new(names: Vec<String>) -> Self {
        let count = names.len();
        Self { names, roles: vec![None; count], units: vec![String::new(); count], scales: [None; Column::COUNT] }
    }

    /// Reads the column at `index` as `column`.
    pub fn assign(&mut self, index: usize, column: Column, unit: &str, scale: Scale) {
        self.roles[index] = Some(column);
        unit.clone_into(&mut self.units[index]);
        self.scales[column.index()] = (scale != Scale::SI).then_some(scale);
    }

    /// Names in the header, as in the file.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// What each column is; `None` is extra.
    #[must_use]
    pub fn roles(&self) -> &[Option<Column>] {
        &self.roles
    }

    /// Unit of the numbers in the file's column.
    pub(crate) fn unit(&self, index: usize) -> &str {
        &self.units[index]
    }

    /// Where a column stands in the file.
    #[must_use]
    pub fn position(&self, column: Column) -> Option<usize> {
        self.roles.iter().position(|role| *role == Some(column))
    }

    /// The names that are extra.
    pub fn extra_names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().zip(&self.roles).filter(|(_, role)| role.is_none()).map(|(name, _)| name.as_str())
    }

    #[inline]
    pub(crate) fn to_si(&self, column: Column, value: f64) -> f64 {
        self.scales[column.index()].map_or(value, |scale| scale.apply(value))
    }
}
