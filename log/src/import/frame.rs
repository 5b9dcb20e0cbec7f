//! From the vehicle's axes into those of the stable member, and out of the vehicle's roll.
//!
//! ```text
//! rel  = integral of w dt                     vehicle against stable member, 0 at the first row
//! a_x  = a_x,vehicle cos rel - a_y,vehicle sin rel
//! a_y  = a_x,vehicle sin rel + a_y,vehicle cos rel
//! ```
//!
//! A strapdown unit measures in the vehicle's axes; the unbalance, and the accelerometers of a platform, are on the
//! stable member, which keeps its direction while the vehicle turns about the gimbal axis.
//!
//! Assumptions: the stable member starts aligned with the vehicle; its own angle (milliradians) is left out; the rate
//! runs along a straight line between rows. Gyro bias makes rel drift: at 0.1 deg/s by 6 deg in a minute.

use crate::{Column, Log};

/// Turns the accelerations of a log, and adds `relative_angle_rad`. Rows must be regular.
///
/// A missing rate counts as the last one known.
pub fn turn_into_stable_member(log: &mut Log) {
    let (Some(time_s), Some(rate_radps)) = (log.column(Column::Time), log.column(Column::VehicleRate)) else {
        return;
    };
    let angles_rad = integral(time_s, rate_radps);
    if let (Some(x), Some(y)) = (log.column(Column::AccelX), log.column(Column::AccelY)) {
        let (x, y) = turned(x, y, &angles_rad);
        log.set(Column::AccelX, x);
        log.set(Column::AccelY, y);
    }
    log.set(Column::RelativeAngle, angles_rad);
}

/// Takes the vehicle's roll out of a log whose gimbal y lies along the roll axis, as a roll gimbal outside of the
/// gimbal axis does.
///
/// ```text
/// Phi  = integral of p dt                     vehicle against the frame that does not roll, 0 at the first row
/// v_z' = v_z cos Phi - v_x sin Phi
/// v_x' = v_z sin Phi + v_x cos Phi            for v the specific force and the rates about z and x
/// ```
///
/// A missing roll rate counts as the last one known.
pub fn take_out_roll(log: &mut Log, roll_rate_radps: &[f64]) {
    let Some(time_s) = log.column(Column::Time) else { return };
    let angles_rad = integral(time_s, roll_rate_radps);
    for (about_z, about_x) in [(Column::AccelZ, Column::AccelX), (Column::VehicleRate, Column::CrossRate)] {
        if let (Some(z), Some(x)) = (log.column(about_z), log.column(about_x)) {
            let (z, x) = turned(z, x, &angles_rad);
            log.set(about_z, z);
            log.set(about_x, x);
        }
    }
}

/// Integral along straight lines between rows, 0 at the first.
fn integral(time_s: &[f64], rate_radps: &[f64]) -> Vec<f64> {
    let mut angle_rad = 0.0;
    let mut last_radps = rate_radps.iter().copied().find(|rate| !rate.is_nan()).unwrap_or(0.0);
    let mut last_s = time_s.first().copied().unwrap_or(0.0);
    let pairs = time_s.iter().zip(rate_radps);
    pairs
        .map(|(&time_s, &rate_radps)| {
            let rate_radps = if rate_radps.is_nan() { last_radps } else { rate_radps };
            angle_rad += 0.5 * (last_radps + rate_radps) * (time_s - last_s);
            (last_radps, last_s) = (rate_radps, time_s);
            angle_rad
        })
        .collect()
}

/// Components of a vector in axes against which the given ones have turned, from the first towards the second.
fn turned(first: &[f64], second: &[f64], angles_rad: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let pairs = first.iter().zip(second).zip(angles_rad);
    pairs
        .map(|((first, second), angle_rad)| {
            let (sine, cosine) = angle_rad.sin_cos();
            (first * cosine - second * sine, first * sine + second * cosine)
        })
        .unzip()
}

#[cfg(test)]
mod tests {
    use super::{take_out_roll, turn_into_stable_member};
    use crate::{Column, Log};

    #[test]
    fn closed_form_a_fixed_direction_stays_fixed_while_the_vehicle_rolls() {
        // Fixed along z of the frame that does not roll; the vehicle rolls at 10 rad/s about y.
        let mut log = Log::default();
        let time_s: Vec<f64> = (0..1000).map(|k| 1e-3 * f64::from(k)).collect();
        for (along_z, along_x) in [(Column::AccelZ, Column::AccelX), (Column::VehicleRate, Column::CrossRate)] {
            log.set(along_z, time_s.iter().map(|t| 5.0 * (10.0 * t).cos()).collect());
            log.set(along_x, time_s.iter().map(|t| -5.0 * (10.0 * t).sin()).collect());
        }
        log.set(Column::Time, time_s);
        take_out_roll(&mut log, &[10.0; 1000]);
        for (along_z, along_x) in [(Column::AccelZ, Column::AccelX), (Column::VehicleRate, Column::CrossRate)] {
            assert!(log.column(along_z).expect("z").iter().all(|z| (z - 5.0).abs() < 1e-12));
            assert!(log.column(along_x).expect("x").iter().all(|x| x.abs() < 1e-12));
        }
    }

    #[test]
    fn closed_form_a_fixed_direction_stays_fixed_while_the_vehicle_spins() {
        // Specific force along the stable member's x; the vehicle turns at 3 rad/s and sees it turn back.
        let mut log = Log::default();
        let time_s: Vec<f64> = (0..1000).map(|k| 1e-3 * f64::from(k)).collect();
        log.set(Column::AccelX, time_s.iter().map(|t| 5.0 * (3.0 * t).cos()).collect());
        log.set(Column::AccelY, time_s.iter().map(|t| -5.0 * (3.0 * t).sin()).collect());
        log.set(Column::VehicleRate, vec![3.0; time_s.len()]);
        log.set(Column::Time, time_s);
        turn_into_stable_member(&mut log);
        let (x, y) = (log.column(Column::AccelX).expect("x"), log.column(Column::AccelY).expect("y"));
        assert!(x.iter().all(|x| (x - 5.0).abs() < 1e-12) && y.iter().all(|y| y.abs() < 1e-12));
        assert!((log.column(Column::RelativeAngle).expect("rel")[999] - 2.997).abs() < 1e-12);
    }
}
