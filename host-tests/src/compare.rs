//! Ways to compare numbers.

/// `|value - expected| / |expected|`.
#[must_use]
pub fn relative(value: f64, expected: f64) -> f64 {
    (value - expected).abs() / expected.abs()
}

/// Slope of the straight line through points, least squares.
#[must_use]
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let product: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    let square: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    product / square
}
