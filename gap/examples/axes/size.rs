//! How large an effect is: a multiple of what shows, measured on the axis without it.

use super::draw::{Axis, Group, Law, TOLERANCE, axis, group, log_uniform, rng, swamped};
use super::effect::{Kind, State, Term};
use super::run::run;

/// What shows: this share of the effort's deviation, beside inertia, viscous and Coulomb friction.
const SHOWS: f64 = 0.015;
/// And this many tolerances of a parameter.
const TOLERANCES: f64 = 1.5;
/// What the bristles of every axis may leave of the effort at most.
const BRISTLES: f64 = 0.01;
/// Axes that are drawn until their loop holds and the effect can show on them.
const ATTEMPTS: u64 = 40;

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    (sum / f64::max(count, 1.0)).sqrt()
}

/// What of a signal is left beside others, by Gram and Schmidt.
fn beside(signal: &[f64], others: &[Vec<f64>]) -> f64 {
    let mut orthogonal: Vec<Vec<f64>> = Vec::new();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let clean = |mut own: Vec<f64>, orthogonal: &[Vec<f64>]| {
        for other in orthogonal {
            let share = dot(&own, other) / dot(other, other).max(1e-300);
            own.iter_mut().zip(other).for_each(|(x, y)| *x -= share * y);
        }
        own
    };
    for other in others {
        let next = clean(other.clone(), &orthogonal);
        orthogonal.push(next);
    }
    rms(clean(signal.to_vec(), &orthogonal).into_iter())
}

/// Largest size that an axis can have of a kind.
fn most(term: &Term, axis: &Axis) -> f64 {
    match term.kind {
        Kind::Inertia => 1.5 * axis.inertia,
        Kind::Viscous => 5.0 * axis.viscous,
        Kind::Level => 3.0 * axis.coulomb,
        Kind::Scale | Kind::LoadDependence | Kind::MotorRipple | Kind::MotorHeating => 0.5,
        Kind::TorqueCurve => 0.12,
        Kind::Stribeck => 1.5 * axis.coulomb,
        Kind::Asymmetry | Kind::FrictionDrift | Kind::PositionFriction => 0.6 * axis.coulomb,
        Kind::LoadFriction => 0.3 * axis.coulomb,
        Kind::Taper => 1.2 * axis.coulomb / axis.travel,
        Kind::ViscousDrift => 0.7 * axis.viscous,
        Kind::Constant | Kind::BiasDrift | Kind::Load | Kind::DeadZone | Kind::Ripple => 0.25 * axis.limit,
        _ => f64::MAX,
    }
}

/// The size of one effect on an axis whose motion without it is `rows`; none where it cannot show.
fn sized(term: &Term, axis: &Axis, rows: &[State], times: f64, sign: f64) -> Option<Term> {
    let mut term = *term;
    let effort = rms(rows.iter().map(|x| x.u));
    match term.kind {
        Kind::Presliding | Kind::TorqueSign => term.size = 1.0,
        Kind::VelocityScale => {
            let factors = [2.0, 0.5, std::f64::consts::TAU, 1.0 / std::f64::consts::TAU, 1.2, 0.8, -1.0];
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
            let place = (times * 7.0) as usize % 7;
            term.size = factors[place];
        }
        Kind::VelocityDelay => term.size = (2.0 + times) * 5e-5 * axis.log_every as f64,
        Kind::Lag => {
            let fast = 4.0 * std::f64::consts::PI * axis.path.hz;
            term.size = (times * SHOWS / fast).min(0.3 / axis.loop_radps);
        }
        Kind::Flexible => {
            let fast = 4.0 * std::f64::consts::PI * axis.path.hz;
            term.number = fast * (0.4 / (SHOWS * times)).sqrt();
            term.size = 1.0;
        }
        Kind::Backlash => term.size = 0.2 + 0.04 * times,
        Kind::ClippedUnseen => {
            let mut sizes: Vec<f64> = rows.iter().map(|x| x.u.abs()).collect();
            sizes.sort_by(f64::total_cmp);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
            let place = (sizes.len() as f64 * (0.98 - 0.01 * times)) as usize;
            term.size = sizes[place];
        }
        _ => {
            if term.kind == Kind::TorqueCurve {
                term.number = 2.0 * effort;
            }
            let unit: Option<Vec<f64>> = rows.iter().map(|x| term.unit(x)).collect();
            let own = [Kind::Inertia, Kind::Viscous, Kind::Level].iter().position(|kind| *kind == term.kind);
            let base: [Vec<f64>; 3] = [
                rows.iter().map(|x| x.a).collect(),
                rows.iter().map(|x| x.v).collect(),
                rows.iter().map(|x| x.s).collect(),
            ];
            let scale = term.kind == Kind::Scale;
            let others: Vec<Vec<f64>> =
                (0..3).filter(|place| Some(*place) != own && !scale).map(|place| base[place].clone()).collect();
            let left = beside(&unit?, &others);
            let shows = SHOWS * effort / left.max(1e-300);
            let known = match own {
                Some(place) => TOLERANCES * TOLERANCE[place] * [axis.inertia, axis.viscous, axis.coulomb][place],
                None if scale => 0.05,
                None => 0.0,
            };
            let least = shows.max(known);
            let most = most(&term, axis);
            if least > most {
                return None;
            }
            // signs that friction, springs and dead zones cannot have are not drawn
            let both = matches!(
                term.kind,
                Kind::Constant
                    | Kind::Asymmetry
                    | Kind::FrictionDrift
                    | Kind::BiasDrift
                    | Kind::Load
                    | Kind::Taper
                    | Kind::HiddenPulses
            );
            term.size = (least * times).min(most) * if both { sign } else { 1.0 };
        }
    }
    Some(term)
}

/// The axis of a seed with its effects in their sizes, multiples of what shows: 1 to 10. None where no axis was found
/// on which they can show.
pub fn drawn(seed: u64) -> Option<Axis> {
    for attempt in 0..ATTEMPTS {
        if group(seed) == Group::Swamped {
            let axis = swamped(seed, attempt);
            if holds(&axis, &run(&axis, &axis.path, 101)) {
                return Some(axis);
            }
            continue;
        }
        let mut axis = axis(seed, attempt);
        let dice = &mut rng(seed, 3);
        let wanted = std::mem::take(&mut axis.terms);
        let path = axis.path.clone();
        let clean = run(&Axis { seconds: axis.seconds.min(10.0), ..axis.clone() }, &path, 100);
        if !holds(&axis, &clean) || bristles_show(&axis, &clean) {
            continue;
        }
        let mut times = || log_uniform(dice, 1.0, 10.0);
        let terms: Option<Vec<Term>> = wanted
            .iter()
            .map(|term| {
                let times = times();
                let sign = if (times * 1000.0).rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
                sized(term, &axis, &clean.rows, times, sign)
            })
            .collect();
        let Some(terms) = terms else { continue };
        axis.terms = terms;
        let short = run(&axis, &path, 101);
        if holds(&axis, &short) {
            return Some(axis);
        }
    }
    None
}

/// Whether the loop holds: it moves as it should, without hanging at the drive's limit or trembling.
fn holds(axis: &Axis, run: &super::run::Run) -> bool {
    let finite = run.rows.iter().all(|x| x.q.is_finite() && x.v.is_finite());
    let moving = rms(run.rows.iter().map(|x| x.v));
    let fastest = run.rows.iter().fold(0.0_f64, |most, x| most.max(x.v.abs()));
    let trembling = rms(run.rows.iter().map(|x| x.a)) > 6.0 * axis.acceleration.max(axis.loop_radps * axis.rate * 0.3);
    let free = axis.law == Law::Rate;
    finite
        && !trembling
        && run.clipped < 0.25
        && moving > 0.05 * axis.rate
        && fastest < if free { 8.0 } else { 6.0 } * axis.rate
}

/// Bristles belong to every axis; on an axis without that effect they do not show.
fn bristles_show(axis: &Axis, clean: &super::run::Run) -> bool {
    let moving = |x: &&State| x.v.abs() > 1e-3 * axis.rate;
    let late = axis.coulomb * rms(clean.rows.iter().filter(moving).map(|x| x.s - x.v.signum()));
    late > BRISTLES * rms(clean.rows.iter().map(|x| x.u))
}
