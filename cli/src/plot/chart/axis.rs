//! An axis: what it shows, where its lines lie, and their values in short.

use super::super::decimal;

/// An axis and what it shows.
pub(crate) struct Axis<'a> {
    /// Quantity and unit, as written.
    pub(crate) label: &'a str,
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) log: bool,
}

impl Axis<'_> {
    /// Share of the axis below a value.
    pub(super) fn share(&self, value: f64) -> f64 {
        let scale = |value: f64| if self.log { value.max(1e-300).log10() } else { value };
        (scale(value) - scale(self.from)) / (scale(self.to) - scale(self.from))
    }

    /// Values with a line of the grid; those of a logarithmic axis are 1, 2 and 5 times powers of ten.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let inside = |value: &f64| (-1e-9..=1.0 + 1e-9).contains(&self.share(*value));
        if self.log {
            // Many decades have room for one line each.
            let digits: &[f64] = if self.to > 2e3 * self.from { &[1.0] } else { &[1.0, 2.0, 5.0] };
            return (-12..=12)
                .flat_map(|decade| digits.iter().map(move |digit| digit * 10_f64.powi(decade)))
                .filter(inside)
                .collect();
        }
        let rough = (self.to - self.from) / 9.0;
        let power = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|step| *step >= rough);
        let step = step.unwrap_or(10.0 * power);
        let first = (self.from / step).ceil();
        (0..24).map(|k| (first + f64::from(k)) * step).filter(inside).collect()
    }
}

/// The pixel at a share of the way between two.
#[allow(clippy::cast_possible_truncation, reason = "a place on paper")]
pub(super) fn along(share: f64, from: i32, to: i32) -> i32 {
    (f64::from(from) + share * f64::from(to - from)).round() as i32
}

/// A tick's value, short.
pub(super) fn rounded(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-4 { format!("{value:.0e}") } else { decimal(value) }
}

#[cfg(test)]
mod tests {
    use super::Axis;

    #[test]
    fn closed_form_ticks_are_round_and_inside() {
        let linear = Axis { label: "", from: 0.0, to: 10.0, log: false };
        assert_eq!(linear.ticks(), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        let log = Axis { label: "", from: 0.9, to: 25.0, log: true };
        assert_eq!(log.ticks(), [1.0, 2.0, 5.0, 10.0, 20.0]);
    }
}
