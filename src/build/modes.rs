//! Real coordinates of the free loop's modes, nine parts that add up to theta.
//!
//! A step of `T_d` by 1 makes theta the sum of `zeta(l) e^(l t)` over the poles l, `zeta = H A(l) / (l P'(l))`:
//! theta has no constant part, because F has an integrator. Driven by the *change* of `T_d`, every mode therefore
//! decays to zero, and no large numbers cancel at rest. Two modes, a complex pair or two real ones, make a block of two
//! coordinates, chosen so that all nine coordinates add up to theta, without large parts that cancel.

use crate::BuildError;
use crate::build::complex::Complex;
use crate::build::plant::{LAGS, Plant};
use crate::build::poles::{ORDER, closed_loop, derivative};

/// Blocks of two coordinates; the ninth mode is real and alone.
pub(crate) const BLOCKS: usize = 4;

/// The gimbal, gyro and servo at one instant, as far as it shapes theta: y, z, theta, theta', phi'.
pub(crate) const PHYSICAL: usize = LAGS + 4;
/// Place of y in the physical state.
pub(crate) const INTEGRATOR: usize = 0;
/// Place of `z_1`.
pub(crate) const LAG: usize = 1;
/// Place of theta.
pub(crate) const ANGLE: usize = LAG + LAGS;
/// Place of theta'.
pub(crate) const RATE: usize = ANGLE + 1;
/// Place of phi'.
pub(crate) const GIMBAL_RATE: usize = RATE + 1;

/// Two modes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pair {
    /// The pole with a positive imaginary part.
    Complex(Complex),
    /// Two real poles.
    Real(f64, f64),
}

/// The coordinates of all modes of a loop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Modes {
    plant: Plant,
    pairs: [Pair; BLOCKS],
    single: f64,
    /// The period over which the second coordinate of a block is the first one's change.
    step: Option<f64>,
}

/// Scale of a complex mode's imaginary part, which is no part of theta: too small to be seen in the sum.
const ASIDE: f64 = 1.0 / 65_536.0;

/// A 2 by 2 matrix, row by row.
type Square = [f64; 4];

impl Modes {
    pub(crate) fn new(plant: &Plant) -> Result<Self, BuildError> {
        let poles = closed_loop(plant)?;
        let mut reals = [0.0; ORDER];
        let mut real_count = 0;
        let mut pairs = [Pair::Real(0.0, 0.0); BLOCKS];
        let mut pair_count = 0;
        for pole in poles {
            if pole.im == 0.0 {
                reals[real_count] = pole.re;
                real_count += 1;
            } else if pole.im > 0.0 {
                if pair_count == BLOCKS {
                    return Err(BuildError::PolesNotFound);
                }
                pairs[pair_count] = Pair::Complex(pole);
                pair_count += 1;
            }
        }
        if 2 * pair_count + real_count != ORDER {
            return Err(BuildError::PolesNotFound);
        }
        for (i, first) in pairs[..pair_count].iter().enumerate() {
            for second in &pairs[..i] {
                if let (Pair::Complex(a), Pair::Complex(b)) = (first, second) {
                    if (*a - *b).abs() < 1e-5 * a.abs() {
                        return Err(BuildError::RepeatedPole { real_radps: a.re, imag_radps: a.im });
                    }
                }
            }
        }
        let single = pair_reals(&mut reals[..real_count], &mut pairs[pair_count..]);
        Ok(Self { plant: *plant, pairs, single, step: None })
    }

    /// The same modes in other coordinates: of each block its part of theta, and what a period changes of it while
    /// nothing drives it. These take fewer products, `x_0 + x_1` instead of two, and need a wide range of sizes.
    pub(crate) fn in_steps(&self, period: f64) -> Self {
        Self { step: Some(period), ..*self }
    }

    /// `e^(M T) - 1` of each block over `period`, and of the single mode.
    pub(crate) fn transition(&self, period: f64) -> ([Square; BLOCKS], f64) {
        let blocks = self.pairs.map(|pair| {
            if self.step == Some(period) {
                let [sum, product] = pair.changes(period);
                return [0.0, 1.0, -product, sum];
            }
            let natural = match pair {
                Pair::Complex(pole) => {
                    let change = exp_minus_one(pole.scale(period));
                    [change.re, -change.im, change.im, change.re]
                }
                Pair::Real(first, second) => [libm::expm1(first * period), 0.0, 0.0, libm::expm1(second * period)],
            };
            let coordinates = pair.coordinates(self.step);
            product(product(coordinates, natural), inverse(coordinates))
        });
        (blocks, libm::expm1(self.single * period))
    }

    /// Factors of the nine coordinates in an output whose value is `of(l)` for a mode whose theta is 1.
    pub(crate) fn row(&self, of: impl Fn(Complex) -> Complex) -> [f64; ORDER] {
        let mut row = [0.0; ORDER];
        for (place, &pair) in row.chunks_exact_mut(2).zip(&self.pairs) {
            let back = inverse(pair.coordinates(self.step));
            let [first, second] = match pair {
                Pair::Complex(pole) => [of(pole).re, -of(pole).im],
                Pair::Real(first, second) => [of(Complex::real(first)).re, of(Complex::real(second)).re],
            };
            place[0] = first * back[0] + second * back[2];
            place[1] = first * back[1] + second * back[3];
        }
        row[ORDER - 1] = of(Complex::real(self.single)).re;
        row
    }

    /// Coordinates of modes whose theta is `weight(l)`, summed over all poles l.
    pub(crate) fn column(&self, weight: impl Fn(Complex) -> Complex) -> [f64; ORDER] {
        let mut column = [0.0; ORDER];
        for (place, &pair) in column.chunks_exact_mut(2).zip(&self.pairs) {
            let coordinates = pair.coordinates(self.step);
            let [first, second] = match pair {
                // A pole and its conjugate together add twice the real part.
                Pair::Complex(pole) => [2.0 * weight(pole).re, 2.0 * weight(pole).im],
                Pair::Real(first, second) => [weight(Complex::real(first)).re, weight(Complex::real(second)).re],
            };
            place[0] = coordinates[0] * first + coordinates[1] * second;
            place[1] = coordinates[2] * first + coordinates[3] * second;
        }
        column[ORDER - 1] = weight(Complex::real(self.single)).re;
        column
    }

    /// What a step of `T_d` by 1 at the start of a period has made of the coordinates at its end.
    pub(crate) fn drive(&self, period: f64) -> [f64; ORDER] {
        self.column(|pole| self.step_weight(pole) * pole.scale(period).exp())
    }

    /// Largest that each coordinate can become while `|T_d| <= 1`, from rest.
    ///
    /// With x the response itself and `x_s` its steady value, a coordinate is `x - x_s`:
    /// `|x| <= |R| / |Re l|` and `|x_s| <= |R| / |l|`, R the residue `l zeta`.
    pub(crate) fn bounds(&self) -> [f64; ORDER] {
        let size = |pole: Complex| {
            let residue = (pole * self.step_weight(pole)).abs();
            residue / pole.re.abs() + residue / pole.abs()
        };
        let mut bounds = [0.0; ORDER];
        for (place, &pair) in bounds.chunks_exact_mut(2).zip(&self.pairs) {
            match pair {
                Pair::Complex(pole) => {
                    let coordinates = pair.coordinates(self.step);
                    place[0] = 2.0 * size(pole) * libm::hypot(coordinates[0], coordinates[1]);
                    place[1] = 2.0 * size(pole) * libm::hypot(coordinates[2], coordinates[3]);
                }
                Pair::Real(first, second) => {
                    let [first, second] = [size(Complex::real(first)), size(Complex::real(second))];
                    let coordinates = pair.coordinates(self.step);
                    place[0] = coordinates[0].abs() * first + coordinates[1].abs() * second;
                    place[1] = coordinates[2].abs() * first + coordinates[3].abs() * second;
                }
            }
        }
        bounds[ORDER - 1] = size(Complex::real(self.single));
        bounds
    }

    /// Columns that turn a physical state, with y less `T_d`, into coordinates.
    pub(crate) fn entry(&self) -> [[f64; ORDER]; PHYSICAL] {
        let plant = &self.plant;
        let (jg, jo, bo, h) = (plant.gimbal_inertia, plant.float_inertia, plant.damping, plant.momentum);
        let residue = |pole: Complex| pole * self.step_weight(pole);
        let lag_weight =
            |pole: Complex, lag| pole.scale(h) * plant.lag_product_without(pole, lag) / derivative(plant, pole);
        let mut columns = [[0.0; ORDER]; PHYSICAL];
        columns[INTEGRATOR] = self.column(|pole| -self.step_weight(pole));
        for lag in 0..LAGS {
            columns[LAG + lag] = self.column(|pole| -lag_weight(pole, lag));
        }
        columns[ANGLE] = self.column(|pole| {
            let gyro = (pole * (pole.scale(jo) + Complex::real(bo))).scale(jg / h);
            let servo =
                (0..LAGS).fold(Complex::default(), |sum, lag| sum + lag_weight(pole, lag).scale(plant.lag_gains[lag]));
            residue(pole) * (Complex::real(h) + gyro) + servo
        });
        columns[RATE] = self.column(|pole| (residue(pole) * pole).scale(jg * jo / h));
        columns[GIMBAL_RATE] = self.column(|pole| residue(pole).scale(jg));
        columns
    }

    /// zeta(l).
    fn step_weight(&self, pole: Complex) -> Complex {
        self.plant.lag_product(pole).scale(self.plant.momentum) / derivative(&self.plant, pole)
    }
}

impl Pair {
    /// Coordinates of a block from the amplitudes of its two modes: the real and imaginary part of a complex one, whose
    /// real part is its theta, and the imaginary part made small; the two thetas of real ones.
    fn coordinates(self, step: Option<f64>) -> Square {
        match (self, step) {
            (Self::Complex(pole), Some(period)) => {
                let change = exp_minus_one(pole.scale(period));
                [1.0, 0.0, change.re, -change.im]
            }
            (Self::Real(first, second), Some(period)) => {
                [1.0, 1.0, libm::expm1(first * period), libm::expm1(second * period)]
            }
            (Self::Complex(pole), None) => {
                // Nearly real: a sine of large amplitude and slow phase, scaled to what it becomes before it decays.
                let slowness = if pole.im < 0.5 * pole.re.abs() { pole.im / pole.abs() } else { 1.0 };
                [1.0, -ASIDE * slowness, 0.0, ASIDE * slowness]
            }
            // Nearly equal poles: their sum and their divided difference, which stay finite as the poles meet.
            (Self::Real(first, second), None) if nearly_equal(first, second) => {
                let difference = (second - first) / first;
                [1.0, 1.0 - difference, 0.0, difference]
            }
            (Self::Real(..), None) => [1.0, 0.0, 0.0, 1.0],
        }
    }

    /// Sum and product of what a period makes of a mode, less the mode.
    fn changes(self, period: f64) -> [f64; 2] {
        match self {
            Self::Complex(pole) => {
                let change = exp_minus_one(pole.scale(period));
                [2.0 * change.re, change.re * change.re + change.im * change.im]
            }
            Self::Real(first, second) => {
                let (first, second) = (libm::expm1(first * period), libm::expm1(second * period));
                [first + second, first * second]
            }
        }
    }
}

fn nearly_equal(first: f64, second: f64) -> bool {
    (second - first).abs() < 0.01 * first.abs()
}

/// Pairs real poles, those nearly equal with one another. Returns the pole left over.
fn pair_reals(reals: &mut [f64], pairs: &mut [Pair]) -> f64 {
    reals.sort_unstable_by(f64::total_cmp);
    let mut left = reals.len();
    for pair in pairs {
        let close = (1..left).find(|&i| nearly_equal(reals[i - 1], reals[i]));
        let first = close.map_or(0, |i| i - 1);
        *pair = Pair::Real(reals[first], reals[first + 1]);
        reals.copy_within(first + 2..left, first);
        left -= 2;
    }
    reals[0]
}

/// `e^z - 1` without cancellation near 0.
fn exp_minus_one(z: Complex) -> Complex {
    let half_sine = libm::sin(0.5 * z.im);
    let growth = libm::expm1(z.re);
    let turn = -2.0 * half_sine * half_sine;
    Complex::new(growth * (1.0 + turn) + turn, (1.0 + growth) * libm::sin(z.im))
}

fn product(a: Square, b: Square) -> Square {
    [a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2], a[2] * b[1] + a[3] * b[3]]
}

fn inverse(a: Square) -> Square {
    let determinant = a[0] * a[3] - a[1] * a[2];
    [a[3] / determinant, -a[1] / determinant, -a[2] / determinant, a[0] / determinant]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Config;

    /// Rows read the physical state back from the modes that `entry` made of it.
    #[test]
    fn closed_form_entry_is_the_inverse_of_the_rows() {
        let plant = Plant::new(&Config::consistent());
        let modes = Modes::new(&plant).unwrap();
        let rows: [[f64; ORDER]; PHYSICAL] = core::array::from_fn(|place| match place {
            INTEGRATOR => modes.row(|s| Complex::real(plant.integrator_gain) / s),
            ANGLE => modes.row(|_| Complex::ONE),
            RATE => modes.row(|s| s),
            GIMBAL_RATE => modes.row(|s| plant.gimbal_rate_of(s)),
            lag => modes.row(|s| plant.lag_state_of(s, lag - LAG)),
        });
        for (given, column) in modes.entry().iter().enumerate() {
            for (read, row) in rows.iter().enumerate() {
                let sum: f64 = row.iter().zip(column).map(|(a, b)| a * b).sum();
                let size: f64 = row.iter().zip(column).map(|(a, b)| (a * b).abs()).sum();
                let expected = if given == read { 1.0 } else { 0.0 };
                assert!((sum - expected).abs() <= 1e-9 * size.max(1.0), "{given} read as {read}: {sum}");
            }
        }
    }

    /// With T5 = T8 a zero of F cancels a lag: the mode is there, and nothing moves or shows it.
    #[test]
    fn closed_form_a_cancelled_lag_takes_no_part() {
        let modes = Modes::new(&Plant::new(&Config::as_printed())).unwrap();
        let lonely = |pole: &f64| (pole + 1.0 / 0.001_68).abs() < 1e-6;
        assert!(modes.pairs.iter().any(|pair| matches!(pair, Pair::Real(a, b) if lonely(a) || lonely(b))));
        let drive = modes.drive(1e-3);
        assert!(drive.iter().filter(|factor| factor.abs() < 1e-12).count() == 1, "{drive:?}");
    }
}
