//! Units of foreign files.

use std::f64::consts::PI;

use crate::{Column, Scale};

const DEGREE_RAD: f64 = PI / 180.0;
/// 1 g [m/s2].
const GRAVITY_MPS2: f64 = 9.806_65;

/// Names of the units, by quantity, for messages.
pub const NAMES: [(&str, &str); 5] = [
    ("s", "s, ms, us, ns, min"),
    ("m/s2", "mps2, g, mg, ftps2"),
    ("rad/s", "radps, mradps, dps, mdps, rpm"),
    ("rad", "rad, mrad, deg, arcmin, arcsec"),
    ("N m", "nm, mnm, dyne_cm, lbf_in"),
];

/// How a number in `unit` becomes the unit of `column`; `None` where the unit is not one of that quantity.
#[must_use]
pub fn scale(column: Column, unit: &str) -> Option<Scale> {
    let factor = match (column.unit(), unit) {
        ("s", "s") | ("m/s2", "mps2") | ("rad/s", "radps") | ("rad", "rad") | ("N m", "nm") | ("deg C", "c") => 1.0,
        ("s", "ms") | ("rad/s", "mradps") | ("rad", "mrad") | ("N m", "mnm") => 1e-3,
        ("s", "us") => 1e-6,
        ("s", "ns") => 1e-9,
        ("s", "min") => 60.0,
        ("m/s2", "g") => GRAVITY_MPS2,
        ("m/s2", "mg") => 1e-3 * GRAVITY_MPS2,
        ("m/s2", "ftps2") => 0.3048,
        ("rad/s", "dps") | ("rad", "deg") => DEGREE_RAD,
        ("rad/s", "mdps") => 1e-3 * DEGREE_RAD,
        ("rad/s", "rpm") => PI / 30.0,
        ("rad", "arcmin") => DEGREE_RAD / 60.0,
        ("rad", "arcsec") => DEGREE_RAD / 3600.0,
        ("N m", "dyne_cm") => 1e-7,
        // 1 lbf in
        ("N m", "lbf_in") => 0.112_984_829_027_616_7,
        ("deg C", "k") => return Some(Scale { factor: 1.0, offset: -273.15 }),
        ("deg C", "f") => return Some(Scale { factor: 5.0 / 9.0, offset: -160.0 / 9.0 }),
        _ => return None,
    };
    Some(Scale { factor, offset: 0.0 })
}

#[cfg(test)]
mod tests {
    use super::{NAMES, scale};
    use crate::Column;

    #[test]
    fn contract_every_unit_named_is_known() {
        for column in Column::ALL {
            for (quantity, units) in NAMES.iter().filter(|(quantity, _)| *quantity == column.unit()) {
                for unit in units.split(", ") {
                    assert!(scale(column, unit).is_some(), "{unit} for {quantity}");
                }
            }
            assert!(scale(column, "furlong").is_none());
        }
    }

    #[test]
    fn closed_form_fixed_points_of_temperature() {
        let celsius = |unit: &str, value: f64| scale(Column::Temperature, unit).expect("known").apply(value);
        assert!((celsius("f", 212.0) - 100.0).abs() < 1e-12);
        assert!(celsius("k", 273.15).abs() < 1e-12);
    }
}
