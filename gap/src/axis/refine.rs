//! Shape parameters where the fit is best: between those that were tried.

use std::f64::consts::TAU;

use super::balance::Balance;
use super::library::Shape;
use super::motion::LEAST_WAVES;
use super::regress::Grams;
use super::search::Candidate;

/// Play of a hysteresis at most, over the travel.
const WIDEST_PLAY: f64 = 0.5;
/// What a number of waves that is not whole must leave of a turning axis, over what the nearest whole one does.
const BEHIND_A_GEAR: f64 = 0.9;
/// Frequencies of a mode, about that of the scan, among which the best one is.
const MODE_SPAN: f64 = 1.08;

impl Balance {
    /// Moves the shape parameters of the members to where the fit is best, and adds those shapes to the library.
    pub(super) fn refine(&mut self, members: &[usize]) {
        let mut added = false;
        for &member in members {
            let shape = self.problem.candidates[member].shape.clone();
            let Some(&(name, value)) = shape.numbers().first() else { continue };
            let wave = name == "wave_number";
            // of fewer waves than the travel tells the number of, one a turn is gravity; another number is a spring
            let least_wave = LEAST_WAVES * TAU / self.motion.travel.max(1e-300);
            if wave && value < least_wave {
                continue;
            }
            let span = if wave { 1.0 + 0.6 / (value * self.motion.travel / 6.0).max(1.0) } else { 1.8 };
            let (from, to) = match &shape {
                Shape::ViscousCurve { .. } => (0.45, 0.85),
                // a resonance has one peak no further than its neighbours in the scan
                Shape::Mode { .. } => (value / MODE_SPAN, value * MODE_SPAN),
                // wider than that it is a spring
                Shape::Hysteresis { .. } => (value / span, (value * span).min(WIDEST_PLAY * self.motion.travel)),
                _ if wave => ((value / span).max(least_wave), value * span),
                _ => (value / span, value * span),
            };
            let rest: Vec<usize> = members.iter().copied().filter(|other| *other != member).collect();
            let cost = |shape: &Shape| self.left_with(shape, &rest);
            let best = match shape {
                Shape::Backlash(play) => {
                    Shape::Backlash(play.refined(&self.motion, |play| cost(&Shape::Backlash(play))))
                }
                _ => shape.with(golden(from, to, |number| cost(&shape.with(number)))),
            };
            // a turn has a whole number of waves, but of what turns behind a gear
            if wave && self.motion.rotary && cost(&best) > BEHIND_A_GEAR * cost(&shape) {
                continue;
            }
            // a hysteresis in the place of friction is friction that follows the way
            if let Shape::Hysteresis { width, yields } = best {
                self.add(Shape::Presliding { displacement: 0.5 * width, yields });
            }
            self.add(best);
            added = true;
        }
        if added {
            let precision = self.problem.grams.precision.clone();
            self.problem.grams = Grams::new(&self.columns, &self.target, &self.motion.block);
            self.problem.grams.precision[..precision.len()].copy_from_slice(&precision);
        }
    }

    /// Squared error with a shape beside members.
    fn left_with(&self, shape: &Shape, members: &[usize]) -> f64 {
        let rest = self.problem.columns(members);
        let mut columns: Vec<Vec<f64>> = rest.iter().map(|&column| self.columns[column].clone()).collect();
        columns.extend(shape.on_grid(&self.motion));
        let mut grams = Grams::new(&columns, &self.target, &self.motion.block);
        for (place, &column) in rest.iter().enumerate() {
            grams.precision[place] = self.problem.grams.precision[column];
        }
        grams.square_of_fit(&(0..columns.len()).collect::<Vec<_>>())
    }

    /// One shape more in the library.
    fn add(&mut self, shape: Shape) {
        let start = self.columns.len();
        self.columns.extend(shape.on_grid(&self.motion));
        for column in &self.columns[start..] {
            let along = if shape.brakes() { self.problem.slip.along(column) } else { Vec::new() };
            self.problem.slip.columns.push(along);
        }
        self.problem.candidates.push(Candidate { shape, columns: (start..self.columns.len()).collect() });
    }
}

/// Smallest value of a function of a logarithm, by golden section.
pub(super) fn golden(from: f64, to: f64, mut cost: impl FnMut(f64) -> f64) -> f64 {
    let ratio = 0.618_034;
    let (mut low, mut high) = (from.ln(), to.ln());
    let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut at_a, mut at_b) = (cost(a.exp()), cost(b.exp()));
    for _ in 0..7 {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - ratio * (high - low);
            at_a = cost(a.exp());
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + ratio * (high - low);
            at_b = cost(b.exp());
        }
    }
    if at_a < at_b { a.exp() } else { b.exp() }
}
