//! Series over rows from which motions are made.

use core::f64::consts::PI;

use super::PERIOD_S;
use crate::draw::Draw;

/// Noise of rms 1 around a frequency: white noise through a second-order resonator of the given width.
pub(super) fn band(rows: usize, frequency_hz: f64, width_hz: f64, draw: &mut Draw) -> Vec<f64> {
    let radius = libm::exp(-PI * width_hz * PERIOD_S);
    let (first, second) = (2.0 * radius * libm::cos(2.0 * PI * frequency_hz * PERIOD_S), -radius * radius);
    let (mut now, mut before) = (0.0, 0.0);
    for _ in 0..2000 {
        (now, before) = (first * now + second * before + draw.normal(), now);
    }
    let series: Vec<f64> = (0..rows)
        .map(|_| {
            (now, before) = (first * now + second * before + draw.normal(), now);
            now
        })
        .collect();
    unit_rms(series)
}

/// Smooth random motion of rms 1 below a corner: two first-order lags in series.
pub(super) fn slow(rows: usize, corner_hz: f64, draw: &mut Draw) -> Vec<f64> {
    let keep = libm::exp(-2.0 * PI * corner_hz * PERIOD_S);
    let (mut first, mut second) = (0.0, 0.0);
    let warm_up = 6000;
    let series: Vec<f64> = (0..rows + warm_up)
        .map(|_| {
            first = keep * first + draw.normal();
            second = keep * second + (1.0 - keep) * first;
            second
        })
        .skip(warm_up)
        .collect();
    unit_rms(series)
}

fn unit_rms(mut series: Vec<f64>) -> Vec<f64> {
    let square: f64 = series.iter().map(|value| value * value).sum::<f64>() / series.len() as f64;
    let rms = libm::sqrt(square).max(f64::MIN_POSITIVE);
    for value in &mut series {
        *value /= rms;
    }
    series
}

/// First-order lag of a series [s].
pub(super) fn lagged(series: &mut [f64], time_s: f64) {
    let keep = libm::exp(-PERIOD_S / time_s);
    let mut state = series.first().copied().unwrap_or(0.0);
    for value in series {
        state = keep * state + (1.0 - keep) * *value;
        *value = state;
    }
}

/// Levels that last a while each, alternating in sign.
pub(super) fn reversals(
    rows: usize,
    lasting_s: (f64, f64),
    size: impl Fn(&mut Draw) -> f64,
    draw: &mut Draw,
) -> Vec<f64> {
    let mut series = Vec::with_capacity(rows);
    let mut sign = draw.sign();
    while series.len() < rows {
        let level = sign * size(draw);
        let until = series.len() as f64 + draw.uniform(lasting_s.0, lasting_s.1) / PERIOD_S;
        while series.len() < rows && (series.len() as f64) < until {
            series.push(level);
        }
        sign = -sign;
    }
    series
}
