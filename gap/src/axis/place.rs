//! Where the gap lies: regimes of the motion, bands, spans, and the friction as a curve over the rate.

use gimbal_model_file::AxisModel;

use super::balance::Balance;
use super::motion::Motion;
use super::plain::nominal;
use super::search::Set;
use crate::place::{Band, Span, Spectrum};

/// A part of the log and what of the gap lies in it.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisRegime {
    /// What it is.
    pub name: String,
    /// Share of the gap's power before.
    pub share: f64,
    /// Share of the rows.
    pub time_share: f64,
    /// Root mean square after, over that before.
    pub left: f64,
}

/// Half width about a reversal [s].
const REVERSAL_S: f64 = 0.05;

/// The regimes of a balance.
pub(super) fn regimes(motion: &Motion, before: &[f64], after: &[f64]) -> Vec<AxisRegime> {
    let n = motion.q.len();
    let mut turning = vec![false; n];
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of rows")]
    let around = (REVERSAL_S / motion.period_s).ceil() as usize;
    let mut direction = 0.0_f64;
    for (k, v) in motion.v.iter().enumerate() {
        if v.abs() > motion.quiet {
            if direction * v < 0.0 {
                turning[k.saturating_sub(around)..(k + around).min(n)].fill(true);
            }
            direction = *v;
        }
    }
    let (low, high) = motion.q.iter().fold((f64::MAX, f64::MIN), |(low, high), q| (low.min(*q), high.max(*q)));
    let third = |row: usize| (3.0 * (motion.q[row] - low) / (high - low).max(1e-300)).min(2.0);
    let late = |row: usize| 3.0 * row as f64 / n as f64;
    let fast = |row: usize| motion.v[row].abs() / motion.fastest.max(1e-300);
    let mut kinds: Vec<(String, Box<dyn Fn(usize) -> bool + '_>)> = vec![
        ("reversal".into(), Box::new(|row| turning[row])),
        ("slip_positive".into(), Box::new(|row| !turning[row] && motion.v[row] > motion.quiet)),
        ("slip_negative".into(), Box::new(|row| !turning[row] && motion.v[row] < -motion.quiet)),
        ("slow".into(), Box::new(|row| fast(row) < 0.1)),
        ("medium_speed".into(), Box::new(|row| (0.1..0.5).contains(&fast(row)))),
        ("fast".into(), Box::new(|row| fast(row) >= 0.5)),
        ("position_low".into(), Box::new(|row| third(row) < 1.0)),
        ("position_middle".into(), Box::new(|row| (1.0..2.0).contains(&third(row)))),
        ("position_high".into(), Box::new(|row| third(row) >= 2.0)),
        ("first_third".into(), Box::new(|row| late(row) < 1.0)),
        ("second_third".into(), Box::new(|row| (1.0..2.0).contains(&late(row)))),
        ("last_third".into(), Box::new(|row| late(row) >= 2.0)),
    ];
    for (name, values) in &motion.auxiliary {
        kinds.push((format!("{name}_on"), Box::new(|row| values[row].abs() > 1e-9)));
        kinds.push((format!("{name}_off"), Box::new(|row| values[row].abs() <= 1e-9)));
    }
    let all: f64 = before.iter().map(|value| value * value).sum::<f64>().max(1e-300);
    kinds
        .iter()
        .filter_map(|(name, holds)| {
            let (mut was, mut is, mut count) = (0.0, 0.0, 0.0);
            for (place, _) in motion.rows.iter().enumerate().filter(|(_, row)| holds(**row)) {
                was += before[place] * before[place];
                is += after[place] * after[place];
                count += 1.0;
            }
            (count > 20.0).then(|| AxisRegime {
                name: name.clone(),
                share: was / all,
                time_share: count / before.len() as f64,
                left: (is / was.max(1e-300)).sqrt(),
            })
        })
        .collect()
}

/// Spectrum of a residual on the grid; rows at rest are zero.
pub(super) fn spectrum(motion: &Motion, values: &[f64]) -> Spectrum {
    let even = motion.in_time(values.iter().copied());
    let valid = vec![true; even.len()];
    Spectrum::new(&even, &valid, motion.floor.max(1e-300), motion.grid_s())
}

/// Shares of the bands, no higher than the balance goes.
pub(super) fn bands(motion: &Motion, values: &[f64]) -> Vec<Band> {
    let mut bands = Spectrum::bands(&[spectrum(motion, values)]);
    bands.retain(|band| band.from_hz < motion.band_hz);
    bands
}

/// Windows in which the effects' contribution exceeds three standard deviations of what is left.
pub(super) fn spans(motion: &Motion, contribution: &[f64], left: f64) -> Vec<Span> {
    let window = 0.5 / motion.grid_s();
    let unit = left.max(1e-300) * window.max(1.0).sqrt();
    crate::place::spans(&motion.in_time(contribution.iter().map(|value| value / unit)), 1, motion.grid_s())
}

/// Friction over rate: what the data show, what the nominal model and the effects say, and a band of confidence.
#[derive(Debug, Clone, Default)]
pub struct FrictionCurve {
    /// Rate, measured friction and its quartiles, nominal, fitted, 2.5 % and 97.5 %.
    pub points: Vec<[f64; 8]>,
}

/// Bins of the curve, half of them to either side.
const BINS: usize = 48;

/// The curve of a fit.
pub(super) fn friction_curve(balance: &Balance, best: &Set, drawn: &[Vec<f64>], model: &AxisModel) -> FrictionCurve {
    let motion = &balance.motion;
    if motion.stands {
        return FrictionCurve::default();
    }
    let (columns, amplitudes) = balance.fit(&best.members);
    let friction: Vec<bool> = columns
        .iter()
        .map(|&column| match balance.problem.base.iter().position(|base| *base == column) {
            Some(place) => balance.base[place].block() == "friction",
            None => best.members.iter().any(|&member| {
                let candidate = &balance.problem.candidates[member];
                candidate.columns.contains(&column) && candidate.shape.block() == "friction"
            }),
        })
        .collect();
    let parameters = nominal(model);
    let sum = |amplitudes: &[f64], row: usize, of_friction: bool| -> f64 {
        let pairs = columns.iter().zip(amplitudes).zip(&friction).filter(|(_, f)| **f == of_friction);
        pairs.map(|((&column, amplitude), _)| amplitude * balance.columns[column][row]).sum()
    };
    let mut bins: Vec<Vec<usize>> = vec![Vec::new(); BINS];
    for (place, &row) in motion.rows.iter().enumerate() {
        let v = motion.v[row];
        if v.abs() < motion.quiet {
            continue;
        }
        // as many bins for slow rates as for fast ones: the square root of the rate
        let at = (v.abs() / motion.fastest).sqrt() * v.signum();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the bins")]
        bins[(((at + 1.0) * 0.5 * BINS as f64) as usize).min(BINS - 1)].push(place);
    }
    let points = bins
        .iter()
        .filter(|bin| bin.len() >= 8)
        .map(|bin| {
            let mean = |f: &dyn Fn(usize) -> f64| bin.iter().map(|&place| f(place)).sum::<f64>() / bin.len() as f64;
            let nominal_at =
                |place: usize| parameters[1] * balance.columns[1][place] + parameters[2] * balance.columns[2][place];
            let mut data: Vec<f64> = bin
                .iter()
                .map(|&place| nominal_at(place) + balance.target[place] - sum(&amplitudes, place, false))
                .collect();
            data.sort_by(f64::total_cmp);
            let quantile = |share: f64| {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
                let index = (share * (data.len() - 1) as f64) as usize;
                data[index]
            };
            let fitted = mean(&|place| nominal_at(place) + sum(&amplitudes, place, true));
            // means of the columns, so that each draw is one product
            let means: Vec<f64> = columns
                .iter()
                .zip(&friction)
                .map(|(&c, f)| if *f { mean(&|p| balance.columns[c][p]) } else { 0.0 })
                .collect();
            let own = mean(&nominal_at);
            let mut draws: Vec<f64> =
                drawn.iter().map(|d| own + d.iter().zip(&means).map(|(a, m)| a * m).sum::<f64>()).collect();
            draws.sort_by(f64::total_cmp);
            let count = draws.len();
            let (low, high) =
                if count < 40 { (fitted, fitted) } else { (draws[count / 40], draws[count - 1 - count / 40]) };
            [mean(&|p| motion.v[motion.rows[p]]), quantile(0.5), quantile(0.25), quantile(0.75), own, fitted, low, high]
        })
        .collect();
    FrictionCurve { points }
}
