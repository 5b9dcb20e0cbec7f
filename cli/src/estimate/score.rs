//! How good an estimate is.

use gimbal_servo::estimator::Flags;
use serde_json::{Value, json};

use super::Course;

/// Against the truth.
pub(super) struct Score {
    error_rms_rad: f64,
    angle_rms_rad: f64,
    before_mps: f64,
    after_mps: f64,
    coverage: f64,
    flags: Flags,
}

impl Score {
    /// Scores all axes together: rms of the vector's length, and the share of all angles within twice their bound.
    pub(super) fn new(course: &Course) -> Self {
        // The first second is not scored: the state before the first row is unknown.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows in a second")]
        let second = (1.0 / course.period_s) as usize;
        let rows = course.times_s.len();
        let from = if rows > 2 * second { second } else { 0 };
        let (mut error, mut square, mut within, mut count) = (0.0, 0.0, 0_usize, 0_usize);
        for axis in &course.axes {
            for k in (from..rows).filter(|&k| axis.truth_rad[k].is_finite()) {
                let (angle, off) = (axis.truth_rad[k], axis.angle_rad[k] - axis.truth_rad[k]);
                error += off * off;
                square += angle * angle;
                within += usize::from(off.abs() <= 2.0 * axis.bound_rad[k]);
                count += 1;
            }
        }
        let before = velocity_error_mps(course);
        let after: [f64; 3] = std::array::from_fn(|axis| before[axis] + course.velocity_correction_mps[axis]);
        let angles = count.max(1) as f64;
        let instants = angles / course.axes.len() as f64;
        Self {
            error_rms_rad: (error / instants).sqrt(),
            angle_rms_rad: (square / instants).sqrt(),
            before_mps: norm(before),
            after_mps: norm(after),
            coverage: within as f64 / angles,
            flags: course.flags.iter().fold(Flags::NONE, |all, flags| all | *flags),
        }
    }

    /// For people.
    pub(super) fn text(&self, course: &Course) -> String {
        let names: Vec<&str> =
            Flags::NAMES.iter().filter(|(flag, _)| self.flags.contains(*flag)).map(|(_, name)| *name).collect();
        let three = course.axes.len() > 1;
        format!(
            "truth                    {}\nattitude error           {:.3e} rad rms after the estimate, {:.3e} rad rms of phi \
             itself\nvelocity error           {:.4e} m/s before, {:.4e} m/s after the correction\n{:<25}{:.1} %\nflags         \
                        {}",
            match (course.measured, three) {
                (true, false) => "gimbal_angle_rad of the log",
                (true, true) => "gimbal_angle_rad_x, _y, _z of the log",
                (false, false) => "the plant under the log's inputs",
                (false, true) => "three plants under the log's inputs",
            },
            self.error_rms_rad,
            self.angle_rms_rad,
            self.before_mps,
            self.after_mps,
            if three { "angles within 2 sigma" } else { "rows within 2 sigma" },
            100.0 * self.coverage,
            if names.is_empty() { "none".to_owned() } else { names.join(", ") }
        )
    }

    /// For programs.
    pub(super) fn json(&self, course: &Course) -> Value {
        json!({
            "axes": course.axes.len(),
            "attitude_error_rms_rad": self.error_rms_rad,
            "attitude_rms_rad": self.angle_rms_rad,
            "velocity_error_before_mps": self.before_mps,
            "velocity_error_after_mps": self.after_mps,
            "bound_coverage_2sigma": self.coverage,
        })
    }
}

fn norm([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).hypot(z)
}

/// (7) over the true phi, `dV' = a x phi`, by trapezoids; one axis is z.
fn velocity_error_mps(course: &Course) -> [f64; 3] {
    let at = |k: usize| {
        let angle = |axis: usize| {
            let place = if course.axes.len() == 1 { (axis == 2).then_some(0) } else { Some(axis) };
            place.map_or(0.0, |place| course.axes[place].truth_rad[k])
        };
        let phi = [angle(0), angle(1), angle(2)].map(|angle| if angle.is_finite() { angle } else { 0.0 });
        let a = course.accels_mps2[k];
        [a[1] * phi[2] - a[2] * phi[1], a[2] * phi[0] - a[0] * phi[2], a[0] * phi[1] - a[1] * phi[0]]
    };
    let mut velocity = [0.0; 3];
    for k in 1..course.accels_mps2.len() {
        let (before, now) = (at(k - 1), at(k));
        for (velocity, (before, now)) in velocity.iter_mut().zip(before.into_iter().zip(now)) {
            *velocity += 0.5 * course.period_s * (before + now);
        }
    }
    velocity
}
