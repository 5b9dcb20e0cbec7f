//! Units of the pictures: angles in degrees, as the paper has them, all else in SI.

/// Below this a quantity takes a prefix.
const LEAST: f64 = 0.01;

/// Factor and name of the unit in which a quantity of this size is shown. A radian is shown in degrees; a torque always with
/// the prefix that brings it into 1..1000, other units below 0.01 alone, so that a figure's numbers are those of its text.
pub(super) fn shown(unit: &str, size: f64) -> (f64, String) {
    match unit {
        "rad" => (180.0 / std::f64::consts::PI, "deg".to_owned()),
        "deg" => (1.0, unit.to_owned()),
        _ => {
            let (factor, prefix) = if unit != "N m" && size >= LEAST { (1.0, "") } else { prefix(size) };
            (factor, format!("{prefix}{unit}"))
        }
    }
}

/// Factor and prefix that bring a size into 1..1000.
fn prefix(size: f64) -> (f64, &'static str) {
    let largest = if size > 0.0 { (1e9, "n") } else { (1.0, "") };
    [(1.0, ""), (1e3, "m"), (1e6, "u")].into_iter().find(|(factor, _)| size * factor >= 1.0).unwrap_or(largest)
}

#[cfg(test)]
mod tests {
    use super::{prefix, shown};

    #[test]
    fn closed_form_prefixes() {
        assert_eq!(prefix(0.002).1, "m");
        assert_eq!(prefix(196.0).1, "");
        assert_eq!(prefix(0.0).1, "");
    }

    #[test]
    fn contract_angles_are_in_degrees_and_torques_in_millinewton_metres() {
        let (factor, unit) = shown("rad", 1e-5);
        assert!((factor * std::f64::consts::PI - 180.0).abs() < 1e-12 && unit == "deg");
        assert_eq!(shown("N m", 0.03), (1e3, "mN m".to_owned()));
        assert_eq!(shown("m/s", 0.107), (1.0, "m/s".to_owned()));
        assert_eq!(shown("m/s", 0.001), (1e3, "mm/s".to_owned()));
    }
}
