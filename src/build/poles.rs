//! Poles of the closed loop: the nine zeros of P(s).

use crate::BuildError;
use crate::build::complex::Complex;
use crate::build::plant::Plant;

/// Order of the loop from `T_d` to theta.
pub(crate) const ORDER: usize = 9;

/// All iterations that the search may take; it needs about twenty.
const SWEEPS: usize = 200;

/// Every pole of the closed loop, exactly real ones marked by `im == 0`, all stable.
///
/// # Errors
/// [`BuildError::UnstablePole`] for the first pole that does not decay, [`BuildError::PolesNotFound`].
pub(crate) fn closed_loop(plant: &Plant) -> Result<[Complex; ORDER], BuildError> {
    let mut poles = aberth(plant)?;
    for pole in &mut poles {
        if pole.im.abs() < 1e-7 * pole.abs() {
            *pole = Complex::real(polish_real(plant, pole.re));
        }
    }
    // The least stable pole is the one to show.
    let worst = poles.iter().fold(poles[0], |worst, &pole| if pole.re > worst.re { pole } else { worst });
    // The slowest pole that a law can carry loses a part in 1e9 a sample.
    if worst.re < -1e-6 {
        Ok(poles)
    } else {
        Err(BuildError::UnstablePole { real_radps: worst.re, imag_radps: worst.im.abs() })
    }
}

/// Aberth's simultaneous iteration, on P in factored form.
fn aberth(plant: &Plant) -> Result<[Complex; ORDER], BuildError> {
    let radius =
        libm::pow(plant.characteristic(Complex::default()).abs() / plant.characteristic_leading(), 1.0 / ORDER as f64);
    // Spread over three decades about the geometric mean, off the real axis and not symmetric about it.
    let mut poles: [Complex; ORDER] = core::array::from_fn(|i| {
        let angle = 2.0 * core::f64::consts::PI * (i as f64 + 0.35) / ORDER as f64;
        let size = radius * libm::pow(10.0, 1.5 * (2.0 * i as f64 / (ORDER - 1) as f64 - 1.0));
        Complex::new(size * libm::cos(angle), size * libm::sin(angle))
    });
    for _ in 0..SWEEPS {
        let mut largest_step = 0.0_f64;
        for i in 0..ORDER {
            let here = poles[i];
            let newton = plant.characteristic(here) / derivative(plant, here);
            let repulsion = (0..ORDER)
                .filter(|&j| j != i)
                .fold(Complex::default(), |sum, j| sum + Complex::ONE / (here - poles[j]));
            let step = newton / (Complex::ONE - newton * repulsion);
            if step.re.is_finite() && step.im.is_finite() {
                poles[i] = here - step;
                largest_step = largest_step.max(step.abs() / here.abs());
            } else if newton != Complex::default() {
                return Err(BuildError::PolesNotFound);
            }
        }
        if largest_step < 1e-14 {
            return Ok(poles);
        }
    }
    // Repeated poles converge slowly and no further than the square root of the precision.
    let settled = poles.iter().all(|&pole| {
        let newton = plant.characteristic(pole) / derivative(plant, pole);
        newton.abs() < 1e-6 * pole.abs() || newton.abs().is_nan()
    });
    if settled { Ok(poles) } else { Err(BuildError::PolesNotFound) }
}

/// P'(s) by the product rule, factor by factor.
pub(crate) fn derivative(plant: &Plant, s: Complex) -> Complex {
    let (jg, jo, bo) = (plant.gimbal_inertia, plant.float_inertia, plant.damping);
    let inertia = plant.inertia_factor(s);
    let inertia_slope = s.scale(2.0 * jg * jo) + Complex::real(jg * bo);
    let lags = plant.lag_product(s);
    let lags_slope = (0..plant.lags.len()).fold(Complex::default(), |sum, i| sum + plant.lag_product_without(s, i));
    let square = s * s;
    inertia_slope * square * lags
        + inertia * s.scale(2.0) * lags
        + inertia * square * lags_slope
        + plant.numerator_slope(s).scale(plant.momentum)
}

/// Newton's iteration along the real axis, which ends at an exactly real pole.
fn polish_real(plant: &Plant, start: f64) -> f64 {
    let mut pole = start;
    for _ in 0..8 {
        let here = Complex::real(pole);
        let step = plant.characteristic(here).re / derivative(plant, here).re;
        if !step.is_finite() || step.abs() > 1e-6 * pole.abs() {
            break;
        }
        pole -= step;
    }
    pole
}
