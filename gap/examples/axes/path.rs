//! References: trapezoids, sines, chirps, steps, slow ramps, random.

use std::f64::consts::TAU;

use rand::RngExt;

/// Which one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Course {
    Trapezoids,
    Sines,
    Chirp,
    Steps,
    Ramps,
    Random,
    /// Constant rates, one after the other: of a rate loop.
    Rates,
}

impl Course {
    pub fn name(self) -> &'static str {
        match self {
            Self::Trapezoids => "trapezoids",
            Self::Sines => "sines",
            Self::Chirp => "chirp",
            Self::Steps => "steps",
            Self::Ramps => "slow ramps",
            Self::Random => "random",
            Self::Rates => "constant rates",
        }
    }
}

/// A reference: position and rate at any time.
#[derive(Debug, Clone)]
pub struct Path {
    pub course: Course,
    /// Typical rate and frequency.
    pub rate: f64,
    pub hz: f64,
    phases: Vec<f64>,
}

/// Integral of a bell from 0 to 1: position over a stroke, minimal jerk.
fn stroke(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
}

impl Path {
    /// Draws one; a rate loop gets rates.
    pub fn draw(rng: &mut impl RngExt, rate_loop: bool) -> Self {
        let courses = [Course::Trapezoids, Course::Sines, Course::Chirp, Course::Steps, Course::Ramps, Course::Random];
        let rates = [Course::Rates, Course::Sines, Course::Random, Course::Trapezoids];
        let course = if rate_loop { rates[rng.random_range(0..4)] } else { courses[rng.random_range(0..6)] };
        Self { course, rate: 1.0, hz: 1.0, phases: (0..24).map(|_| rng.random_range(0.0..1.0)).collect() }
    }

    /// The same course with other phases: another log of the same axis.
    pub fn other(&self, rng: &mut impl RngExt) -> Self {
        Self { phases: (0..24).map(|_| rng.random_range(0.0..1.0)).collect(), ..self.clone() }
    }

    /// Position and rate at a time.
    pub fn at(&self, t: f64, seconds: f64) -> (f64, f64) {
        let w = TAU * self.hz;
        let size = self.rate / w;
        let n = &self.phases;
        let sines = |count: usize, spread: f64| {
            let (mut q, mut v) = (0.0, 0.0);
            for (i, phase) in n.iter().take(count).enumerate() {
                let own = w * spread.powf(2.0 * (i as f64 + 0.5) / count as f64 - 1.0) * (1.0 + 0.1 * n[23 - i]);
                let amplitude = 1.4 * size * (w / own) / (count as f64).sqrt();
                q += amplitude * ((own * t + TAU * phase).sin() - (TAU * phase).sin());
                v += amplitude * own * (own * t + TAU * phase).cos();
            }
            (q, v)
        };
        match self.course {
            Course::Sines => sines(5, 4.0),
            Course::Random => sines(12, 6.0),
            Course::Chirp => {
                let (from, to) = (w * 0.3, w * (3.0 + 3.0 * n[0]));
                let phase = from * t + 0.5 * (to - from) * t * t / seconds;
                let own = from + (to - from) * t / seconds;
                (self.rate / (0.5 * (from + to)) * (phase.sin()), self.rate * own / (0.5 * (from + to)) * phase.cos())
            }
            Course::Trapezoids | Course::Steps => {
                let length = 1.0 / self.hz;
                let index = (t / length).floor();
                let target = |k: f64| {
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of strokes")]
                    let place = k.max(0.0) as usize;
                    let up = if place.is_multiple_of(2) { -1.0 } else { 1.0 };
                    up * size * (0.3 + 0.9 * n[place % 24])
                };
                let (from, to) = (target(index), target(index + 1.0));
                let from = if index == 0.0 { 0.0 } else { from };
                if self.course == Course::Steps {
                    return (0.6 * to, 0.0);
                }
                let share = (t / length - index) * 1.25;
                let slope = (stroke(share + 1e-6) - stroke(share - 1e-6)) / 2e-6;
                (from + (to - from) * stroke(share), (to - from) * slope * 1.25 / length)
            }
            Course::Ramps => {
                // a triangle whose rate changes from period to period
                let x = t * self.hz * 0.5;
                let index = x.floor();
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of periods")]
                let height = size * (0.15 + n[index as usize % 24]);
                let place = x - index;
                let tri = if place < 0.5 { place } else { 1.0 - place };
                let rate = if place < 0.5 { 1.0 } else { -1.0 };
                (2.0 * height * tri, height * rate * self.hz)
            }
            Course::Rates => {
                let length = 3.0 / self.hz;
                let index = (t / length).floor();
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of steps")]
                let place = index as usize;
                let up = if place % 3 == 1 { -1.0 } else { 1.0 };
                let of = |k: usize| self.rate * (0.15 + 0.85 * n[k % 24]);
                (0.0, up * of(place))
            }
        }
    }
}
