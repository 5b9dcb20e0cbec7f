//! From the vehicle's axes into those of the stable member.
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

/// Turns the accelerations and the cross rate of a log, and adds `relative_angle_rad`. Rows must be regular.
///
/// A missing rate counts as the last one known.
pub fn turn_into_stable_member(log: &mut Log) {
    let (Some(time_s), Some(rate_radps)) = (log.column(Column::Time), log.column(Column::VehicleRate)) else {
        return;
    };
    let mut angle_rad = 0.0;
    let mut last_radps = rate_radps.iter().copied().find(|rate| !rate.is_nan()).unwrap_or(0.0);
    let mut last_s = time_s.first().copied().unwrap_or(0.0);
    let mut angles_rad = Vec::with_capacity(time_s.len());
    for (&time_s, &rate_radps) in time_s.iter().zip(rate_radps) {
        let rate_radps = if rate_radps.is_nan() { last_radps } else { rate_radps };
        angle_rad += 0.5 * (last_radps + rate_radps) * (time_s - last_s);
        (last_radps, last_s) = (rate_radps, time_s);
        angles_rad.push(angle_rad);
    }
    let turned = |x: &[f64], y: &[f64]| -> (Vec<f64>, Vec<f64>) {
        let pairs = x.iter().zip(y).zip(&angles_rad);
        pairs
            .map(|((x, y), angle_rad)| {
                let (sine, cosine) = angle_rad.sin_cos();
                (x * cosine - y * sine, x * sine + y * cosine)
            })
            .unzip()
    };
    if let (Some(x), Some(y)) = (log.column(Column::AccelX), log.column(Column::AccelY)) {
        let (x, y) = turned(x, y);
        log.set(Column::AccelX, x);
        log.set(Column::AccelY, y);
    }
    log.set(Column::RelativeAngle, angles_rad);
}

#[cfg(test)]
mod tests {
    use super::turn_into_stable_member;
    use crate::{Column, Log};

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
