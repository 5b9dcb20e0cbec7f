//! A load behind a play: what its drive gives it, and the plays at which a residual speaks for one.
//!
//! ```text
//! effort = J a + B v + F s + m (push - a - slowing s)        m: inertia of the load, m slowing its friction
//! du/dt = push - slowing sgn(u)        push = w^2 beyond + 2 d w (v - u) in the direction of what is beyond the play, else 0
//! ```
//!
//! J and F hold the load. A side of the play is a spring with a damper that pushes and does not pull.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::beside::{Beside, apart};
use super::library::Shape;
use super::motion::Motion;
use super::refine::golden;
use super::smooth::Kernel;

/// A load behind a play, which its own friction slows down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Play {
    /// From the one side to the other.
    pub(super) width: f64,
    /// Friction of the load over its inertia.
    pub(super) slowing: f64,
    /// Natural frequency of the load on a side, and its damping ratio.
    pub(super) contact_radps: f64,
    pub(super) damping: f64,
}

/// Steps of the load in a row at most, and how far the natural frequency goes on in one.
const MOST_STEPS: usize = 20;
const STEP: f64 = 0.25;
/// Widths that are tried over the travel, and from one to the next; at least so many deviations of a position's noise.
const NARROWEST: f64 = 2.5e-4;
const WIDEST: f64 = 0.2;
const WIDER: f64 = 1.3;
const NOISES: f64 = 4.0;
/// Friction over inertia of the load, over that of the whole axis.
const SLOWINGS: [f64; 3] = [0.3, 1.0, 3.0];
const MOST_SLOWED: f64 = 3.0;
const NEAR_MOST: f64 = 0.95;
/// Sides: their natural frequency over the band's edge, and how they damp.
const STIFF: [f64; 2] = [0.7, 2.5];
const DAMPINGS: [f64; 2] = [0.2, 0.5];
/// Blur of what is left, first and last [rows of the balance].
const BLURS: [f64; 3] = [10.0, 3.0, 0.3];
/// Plays that are offered, and how far apart their widths are.
const OFFERED: usize = 2;
const APART: f64 = 1.5;
/// How far each parameter goes from what was tried.
const SPAN: f64 = 1.7;

impl Play {
    /// What the drive gives the load over the load's inertia, at every row.
    pub(super) fn push(&self, m: &Motion) -> Vec<f64> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few steps")]
        let steps = ((self.contact_radps * m.period_s / STEP).ceil() as usize).clamp(1, MOST_STEPS);
        let step_s = m.period_s / steps as f64;
        let half = 0.5 * self.width;
        // the drive is ahead of its load
        let mut ahead = half * m.s.first().copied().unwrap_or(1.0).signum();
        let mut rate = m.v.first().copied().unwrap_or(0.0);
        (0..m.v.len())
            .map(|k| {
                let mut sum = 0.0;
                for step in 0..steps {
                    let drive = m.v[k] + (step as f64 + 0.5 - 0.5 * steps as f64) * step_s * m.a[k];
                    let beyond = ahead - ahead.clamp(-half, half);
                    let pushed =
                        self.contact_radps * (self.contact_radps * beyond + 2.0 * self.damping * (drive - rate));
                    let push = if pushed * beyond > 0.0 { pushed } else { 0.0 };
                    let free = rate + push * step_s;
                    rate = free.signum() * (free.abs() - self.slowing * step_s).max(0.0);
                    ahead += (drive - rate) * step_s;
                    sum += push;
                }
                sum / steps as f64
            })
            .collect()
    }

    /// Whether its load is more than friction: of a light one with much of it, a play is what friction does at a reversal.
    fn is_likely(&self, m: &Motion) -> bool {
        self.slowed(m) <= MOST_SLOWED
    }

    /// Friction over inertia of the load, over that of the whole axis.
    fn slowed(&self, m: &Motion) -> f64 {
        self.slowing * m.nominal[0] / m.nominal[2].max(1e-300)
    }

    /// The likely play about this one that costs least, its parameters one after the other, twice.
    pub(super) fn refined(self, m: &Motion, cost: impl Fn(Self) -> f64) -> Self {
        let cost = |play: Self| if play.is_likely(m) { cost(play) } else { f64::MAX };
        self.refined_once(&cost).refined_once(&cost)
    }

    fn refined_once(self, cost: &impl Fn(Self) -> f64) -> Self {
        let with: [(f64, fn(Self, f64) -> Self); 4] = [
            (self.width, |play, width| Self { width, ..play }),
            (self.slowing, |play, slowing| Self { slowing, ..play }),
            (self.contact_radps, |play, contact_radps| Self { contact_radps, ..play }),
            (self.damping, |play, damping| Self { damping, ..play }),
        ];
        with.into_iter().filter(|(value, _)| *value > 0.0).fold(self, |best, (value, with)| {
            let moved = with(best, golden(value / SPAN, value * SPAN, |number| cost(with(best, number))));
            if cost(moved) < cost(best) { moved } else { best }
        })
    }
}

/// Plays that take most of what base columns and a constant leave of a balance. A load comes to the other side at a moment
/// that hangs on everything: what is left is blurred first, and less and less as the play comes nearer.
pub(super) fn plays(motion: &Motion, target: &[f64], base: &[Vec<f64>]) -> Vec<Shape> {
    let levels: Vec<Level> = BLURS.iter().filter_map(|blur| Level::new(motion, *blur, target, base)).collect();
    let Some(sharpest) = levels.last() else { return Vec::new() };
    let gains = |play: &Play| {
        let column = Shape::Backlash(*play).on_grid(motion).remove(0);
        levels.iter().map(|level| level.gain_of(&column)).collect::<Vec<f64>>()
    };
    let width = |play: &Play| play.width;
    let all = tried(motion);
    let gains: Vec<Vec<f64>> = all.par_iter().map(gains).collect();
    let scanned = (0..levels.len()).flat_map(|level| {
        let of_level = all.iter().zip(&gains).map(|(play, gains)| (gains[level], *play)).collect();
        apart(of_level, OFFERED, APART, width).into_iter().map(move |play| (level, play))
    });
    let nearer = |(level, play): (usize, Play)| {
        let nearest = levels[level..].iter().fold(play, |play, level| play.refined(motion, |play| -level.gain(play)));
        // one that would be lighter if it might has no load
        (if nearest.slowed(motion) < NEAR_MOST * MOST_SLOWED { sharpest.gain(nearest) } else { 0.0 }, nearest)
    };
    let refined: Vec<(f64, Play)> = scanned.collect::<Vec<_>>().into_par_iter().map(nearer).collect();
    let gaining = refined.into_iter().filter(|(gain, _)| *gain > 0.0).collect();
    apart(gaining, OFFERED, APART, width).into_iter().map(Shape::Backlash).collect()
}

/// What is scanned.
fn tried(motion: &Motion) -> Vec<Play> {
    let slowing = motion.nominal[2] / motion.nominal[0];
    let narrowest = (NARROWEST * motion.travel).max(NOISES * motion.position_noise);
    let widths = std::iter::successors(Some(narrowest), |width| Some(width * WIDER));
    let mut all = Vec::new();
    for width in widths.take_while(|width| *width < WIDEST * motion.travel) {
        for (share, stiff) in SLOWINGS.into_iter().flat_map(|share| STIFF.map(|stiff| (share, stiff))) {
            let contact_radps = TAU * stiff * motion.band_hz;
            all.extend(DAMPINGS.map(|damping| Play { width, slowing: share * slowing, contact_radps, damping }));
        }
    }
    all
}

/// A balance, blurred.
struct Level<'a> {
    motion: &'a Motion,
    blur: Kernel,
    beside: Beside,
}

impl<'a> Level<'a> {
    fn new(motion: &'a Motion, blur: f64, target: &[f64], base: &[Vec<f64>]) -> Option<Self> {
        let blur = Kernel::new(blur, 0, 1.0);
        let base: Vec<Vec<f64>> = base.iter().map(|column| blur.apply(column)).collect();
        let beside = Beside::new(blur.apply(target), &base)?;
        Some(Self { motion, blur, beside })
    }

    fn gain(&self, play: Play) -> f64 {
        self.gain_of(&Shape::Backlash(play).on_grid(self.motion)[0])
    }

    fn gain_of(&self, column: &[f64]) -> f64 {
        self.beside.gain(&self.blur.apply(column))
    }
}
