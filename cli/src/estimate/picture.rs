//! The estimate with its bound as a band, and how far it is from the truth.

use std::io::Write;
use std::path::Path;

use gimbal_log::AtomicFile;
use gimbal_servo::estimator::Flags;

use super::{Axis, Course};
use crate::exit::Failure;
use crate::plot::{self, Envelope, Figure, Line, Panel};

/// What is drawn of an axis.
struct Drawn {
    titles: [String; 2],
    phi: Envelope,
    estimate: Envelope,
    band: [Envelope; 2],
    error: Envelope,
    bounds: [Envelope; 2],
}

impl Drawn {
    fn new(course: &Course, axis: &Axis) -> Self {
        let titles = [format!("phi{}", axis.suffix), format!("Estimate less truth{}", axis.suffix)];
        let [phi, estimate, error] = [(); 3].map(|()| Envelope::new());
        let [band, bounds] = [(); 2].map(|()| [Envelope::new(), Envelope::new()]);
        let mut drawn = Self { titles, phi, estimate, band, error, bounds };
        for k in course.shown() {
            let (time_s, truth, angle) = (course.times_s[k], axis.truth_rad[k], axis.angle_rad[k]);
            let two_sigma = 2.0 * axis.bound_rad[k];
            drawn.phi.push(time_s, truth);
            drawn.estimate.push(time_s, angle);
            drawn.error.push(time_s, angle - truth);
            for (place, sign) in [1.0, -1.0].into_iter().enumerate() {
                drawn.band[place].push(time_s, angle + sign * two_sigma);
                drawn.bounds[place].push(time_s, sign * two_sigma);
            }
        }
        drawn
    }

    fn panels(&self) -> [Panel<'_>; 2] {
        let truth = vec![Line::new("estimate", &self.estimate), Line::new("true", &self.phi)];
        let error = vec![Line::new("error", &self.error)];
        [
            Panel::new(&self.titles[0], "rad", truth).with_band("estimate +- 2 sigma", &self.band),
            Panel::new(&self.titles[1], "rad", error).with_band("+- 2 sigma", &self.bounds),
        ]
    }
}

impl Course {
    /// Rows that are drawn: the bound of the first ones, of which nothing is known before, would hide all others.
    fn shown(&self) -> std::ops::Range<usize> {
        let rows = self.times_s.len();
        if rows > 1_000 { 100..rows } else { 0..rows }
    }
}

/// Draws it.
pub(super) fn draw(path: &Path, course: &Course) -> Result<(), Failure> {
    let drawn: Vec<Drawn> = course.axes.iter().map(|axis| Drawn::new(course, axis)).collect();
    let mut stop = Envelope::new();
    for k in course.shown() {
        stop.push(course.times_s[k], f64::from(u8::from(course.flags[k].contains(Flags::SATURATED))));
    }
    let panels = drawn.iter().flat_map(Drawn::panels).collect();
    let shaded = stop.spans_above(0.5);
    let figure = Figure { title: "Attitude estimate", panels, shaded: &shaded, shaded_name: "gyro on its stop" };
    let text = plot::svg(&figure).map_err(|error| Failure::Environment(anyhow::Error::msg(error)))?;
    let fail = || Failure::write(path);
    let mut file = AtomicFile::create(path).map_err(fail())?;
    file.write_all(text.as_bytes()).map_err(fail())?;
    file.commit().map_err(fail())
}
