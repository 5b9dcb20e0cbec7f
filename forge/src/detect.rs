//! How large an effect must be to be seen, from the true plant with and without it.
//!
//! ```text
//! d(size) = min over |p_i| <= tolerance_i of | W (y(effect) - y(without) - S p) |
//! ```
//!
//! y: the logged channels of the record without its first second. W: one over the amplitude spectrum of the noise
//! floor, which is the instruments' noise plus the noise of the logged inputs carried through the plant. S: finite
//! differences of y by the nominal parameters; a parameter may move from where it truly is to either end of its
//! tolerance. Where a difference is large, y(without) is taken anew where they have moved to, as y is no line in them. The
//! smallest detectable size is the one with d = 5.

use std::rc::Rc;

use realfft::RealFftPlanner;

use crate::scene::Outputs;

/// d at which an effect counts as detectable.
pub const DETECTABLE: f64 = 5.0;
/// The first second is not scored: the state before the record is unknown.
pub const UNSCORED_S: f64 = 1.0;
/// Share of the record over which it fades in and out before the transform.
const TAPER: f64 = 0.04;
/// Values over which the power of a whitened random series is taken.
const SMOOTH: usize = 64;
/// Rows of one piece of the noise spectrum.
const PIECE: usize = 2048;

/// Weighs differences by the noise floor.
pub struct Whitener {
    /// Channels that are logged.
    used: Vec<usize>,
    skip: usize,
    length: usize,
    /// Values of a transform for each row.
    padding: f64,
    /// One over the noise amplitude by frequency, one list a channel used.
    weights: Vec<Vec<f64>>,
}

fn taper(place: usize, count: usize) -> f64 {
    let edge = (TAPER * count as f64).max(1.0);
    let near = (place.min(count - 1 - place) as f64 + 0.5) / edge;
    if near >= 1.0 { 1.0 } else { 0.5 - 0.5 * libm::cos(core::f64::consts::PI * near) }
}

/// Power of each frequency of a piece, mean over pieces that overlap by half; white noise of rms 1 gives 1.
fn spectrum(series: &[f64]) -> Vec<f64> {
    let forward = RealFftPlanner::<f64>::new().plan_fft_forward(PIECE);
    let window: Vec<f64> = (0..PIECE)
        .map(|place| 0.5 - 0.5 * libm::cos(2.0 * core::f64::consts::PI * (place as f64 + 0.5) / PIECE as f64))
        .collect();
    let power: f64 = window.iter().map(|value| value * value).sum();
    let mut sum = vec![0.0; PIECE / 2 + 1];
    let mut pieces = 0.0_f64;
    let mut output = forward.make_output_vec();
    for start in (0..=series.len().saturating_sub(PIECE)).step_by(PIECE / 2) {
        let piece = &series[start..(start + PIECE).min(series.len())];
        let mut input: Vec<f64> = piece.iter().zip(&window).map(|(value, weight)| value * weight).collect();
        input.resize(PIECE, 0.0);
        if forward.process(&mut input, &mut output).is_ok() {
            for (total, value) in sum.iter_mut().zip(&output) {
                *total += value.norm_sqr() / power;
            }
        }
        pieces += 1.0;
    }
    sum.iter().map(|total| total / pieces.max(1.0)).collect()
}

impl Whitener {
    /// From one realisation of the noise floor; `used` are the channels that the log has.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a thousand rows; a place in a list
    pub fn new(noise: &Outputs, used: &[usize], period_s: f64) -> Self {
        let skip = (UNSCORED_S / period_s) as usize;
        let count = noise[0].len() - skip;
        let length = count.next_power_of_two();
        let weights = used
            .iter()
            .map(|channel| {
                let power = spectrum(&noise[*channel][skip..]);
                (0..=length / 2)
                    .map(|bin| {
                        let place = bin as f64 * PIECE as f64 / length as f64;
                        let low = (place as usize).min(power.len() - 2);
                        let value = power[low] + (power[low + 1] - power[low]) * (place - low as f64);
                        // Parseval: the transform of `count` rows sums to `length` times their squares
                        let twice = if bin == 0 || bin == length / 2 { 1.0 } else { 2.0 };
                        libm::sqrt(twice / (value.max(1e-40) * length as f64))
                    })
                    .collect()
            })
            .collect();
        Self { used: used.to_vec(), skip, length, padding: length as f64 / count as f64, weights }
    }

    /// The whitened difference of two runs; its norm is d.
    #[must_use]
    pub fn difference(&self, with: &Outputs, without: &Outputs) -> Vec<f64> {
        let forward = RealFftPlanner::<f64>::new().plan_fft_forward(self.length);
        let mut all = Vec::with_capacity(self.used.len() * (self.length + 2));
        let mut output = forward.make_output_vec();
        for (channel, weights) in self.used.iter().zip(&self.weights) {
            let (with, without) = (&with[*channel][self.skip..], &without[*channel][self.skip..]);
            let count = with.len();
            let mut input: Vec<f64> =
                with.iter().zip(without).enumerate().map(|(place, (a, b))| (a - b) * taper(place, count)).collect();
            input.resize(self.length, 0.0);
            if forward.process(&mut input, &mut output).is_err() {
                continue;
            }
            for (value, weight) in output.iter().zip(weights) {
                all.push(value.re * weight);
                all.push(value.im * weight);
            }
        }
        all
    }

    /// d of a random series: by its power s over that of the noise, `sqrt(sum s^2 / 2)` over all independent values.
    #[must_use]
    pub fn power_of(&self, whitened: &[f64]) -> f64 {
        let block = |values: &[f64]| {
            let squares: f64 = values.iter().map(|value| value * value).sum();
            // a mean of n squares, squared, is more than the square of what it stands for
            squares * squares / (values.len() as f64 + 2.0)
        };
        (0.5 * self.padding * whitened.chunks(SMOOTH).map(block).sum::<f64>()).sqrt()
    }
}

/// A direction that the nominal model may move along.
#[derive(Debug, Clone)]
pub struct Nuisance {
    /// Whitened change for one unit.
    pub column: Vec<f64>,
    /// Least and largest move, in units.
    pub limits: (f64, f64),
    /// The effect that this parameter beyond its tolerance is.
    pub name: &'static str,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Directions with their products, for many least squares.
#[derive(Debug, Clone)]
pub struct Projection<'a> {
    nuisances: Vec<&'a Nuisance>,
    /// How far each may still move.
    limits: Vec<(f64, f64)>,
    products: Rc<Vec<Vec<f64>>>,
}

impl<'a> Projection<'a> {
    /// Products of all pairs of directions.
    #[must_use]
    pub fn new(nuisances: Vec<&'a Nuisance>) -> Self {
        let products =
            nuisances.iter().map(|a| nuisances.iter().map(|b| dot(&a.column, &b.column)).collect()).collect();
        let limits = nuisances.iter().map(|nuisance| nuisance.limits).collect();
        Self { nuisances, limits, products: Rc::new(products) }
    }

    /// The same from where the directions have been moved to.
    #[must_use]
    pub fn moved(&self, moves: &[f64]) -> Self {
        let limits = self.limits.iter().zip(moves).map(|((least, most), by)| (least - by, most - by)).collect();
        Self { limits, ..self.clone() }
    }

    /// The directions.
    #[must_use]
    pub fn nuisances(&self) -> &[&'a Nuisance] {
        &self.nuisances
    }

    /// Norm of what is left of a difference after the directions have taken from it what they can within limits.
    #[must_use]
    pub fn left_of(&self, difference: &[f64]) -> f64 {
        self.left_with(difference, &[])
    }

    /// The same with directions beside that have no limits.
    #[must_use]
    pub fn left_with(&self, difference: &[f64], free: &[&[f64]]) -> f64 {
        self.closest(difference, free).1
    }

    /// How far the directions, and those beside that have no limits, move to take most of a difference; and the norm of
    /// what is left of it.
    #[must_use]
    pub fn closest(&self, difference: &[f64], free: &[&[f64]]) -> (Vec<f64>, f64) {
        let fixed = self.nuisances.len();
        let count = fixed + free.len();
        let column = |index: usize| if index < fixed { &self.nuisances[index].column[..] } else { free[index - fixed] };
        let product =
            |a: usize, b: usize| if a < fixed && b < fixed { self.products[a][b] } else { dot(column(a), column(b)) };
        let products: Vec<Vec<f64>> = (0..count).map(|a| (0..count).map(|b| product(a, b)).collect()).collect();
        let pulls: Vec<f64> = (0..count).map(|index| dot(column(index), difference)).collect();
        let mut moves = vec![0.0; count];
        // coordinate descent: the problem is convex, and each pass is a few hundred multiplications
        for _ in 0..4000 {
            let mut largest = 0.0_f64;
            for index in 0..count {
                let own = products[index][index];
                if own <= 1e-12 {
                    continue;
                }
                let others: f64 =
                    products[index].iter().zip(&moves).map(|(a, b)| a * b).sum::<f64>() - own * moves[index];
                let best = (pulls[index] - others) / own;
                let (least, most) = if index < fixed { self.limits[index] } else { (f64::NEG_INFINITY, f64::INFINITY) };
                let moved = best.clamp(least, most);
                largest = largest.max((moved - moves[index]).abs() * own.sqrt());
                moves[index] = moved;
            }
            if largest < 1e-3 {
                break;
            }
        }
        let mut left = dot(difference, difference);
        for a in 0..count {
            left -= 2.0 * moves[a] * pulls[a];
            for b in 0..count {
                left += moves[a] * moves[b] * products[a][b];
            }
        }
        (moves, left.max(0.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    #[test]
    fn white_noise_of_some_power_stands_out_by_it_and_by_the_root_of_half_the_rows() {
        let mut draw = Draw::new(&Draw::seed_of(5), 0);
        // rows that are no power of two: the transform is padded
        let mut series =
            |rms: f64| -> Outputs { core::array::from_fn(|_| (0..11_000).map(|_| rms * draw.normal()).collect()) };
        let (noise, random, none) = (series(1.0), series(0.3), series(0.0));
        let whitener = Whitener::new(&noise, &[0], 1e-3);
        let d = whitener.power_of(&whitener.difference(&random, &none));
        let expected = 0.3 * 0.3 * (0.5_f64 * 10_000.0).sqrt();
        assert!((d / expected - 1.0).abs() < 0.1, "{d} {expected}");
    }
}
