//! The whole way from the log of an axis to a diagnosis.

use gimbal_model_file::AxisModel;

use super::balance::Balance;
use super::columns::ColumnFault;
use super::judge::{Found, Parameter, Ranked, Shrunk};
use super::library::{NOMINAL, Shape, rms};
use super::looked::Looked;
use super::place::{AxisRegime, FrictionCurve, bands, friction_curve, regimes, spans, spectrum};
use super::search::Set;
use super::table::AxisLog;
use super::unseen;
use crate::judge::Verdict;
use crate::place::{Band, Span, Spectrum};

/// How far from one the number of waves a turn of gravity may be.
const ONE_A_TURN: f64 = 0.15;

/// Lines over time for the page: time, effort, nominal model, with effects; and the residuals.
#[derive(Debug, Clone, Default)]
pub(super) struct Lines {
    pub(super) time_s: Vec<f64>,
    pub(super) effort: Vec<f64>,
    pub(super) nominal: Vec<f64>,
    pub(super) fitted: Vec<f64>,
}

/// Everything that a report says about the log of an axis.
#[derive(Debug)]
pub struct AxisDiagnosis {
    /// Rows, period and time of the first row.
    pub rows: usize,
    /// [s].
    pub period_s: f64,
    /// [s].
    pub first_s: f64,
    /// Upper edge of the band of the balance [Hz].
    pub band_hz: f64,
    /// Unit of the effort.
    pub effort_unit: String,
    /// Unit of the position.
    pub position_unit: &'static str,
    /// The verdict.
    pub verdict: Verdict,
    /// Effects, columns that are not what they say among them.
    pub found: Vec<Found>,
    /// Sets by probability.
    pub ranking: Vec<Ranked>,
    /// Sets that this log cannot tell from the one named.
    pub alternatives: Vec<Ranked>,
    /// That no effect of the library is it.
    pub unknown_probability: f64,
    /// Shares of the blocks.
    pub blocks: Vec<(String, f64)>,
    /// Shares of the regimes.
    pub regimes: Vec<AxisRegime>,
    /// Shares of the bands.
    pub bands: Vec<Band>,
    /// When.
    pub spans: Vec<Span>,
    /// Before and after: this log on blocks held out, then logs that were not fitted.
    pub shrunk: Vec<Shrunk>,
    /// Smallest amplitudes that would have been seen: effect, amplitude if any.
    pub detectable: Vec<(String, Option<f64>)>,
    /// What the columns say about each other.
    pub columns: Vec<String>,
    /// Remarks.
    pub notes: Vec<String>,
    /// Friction over rate.
    pub curve: FrictionCurve,
    pub(super) lines: Lines,
    pub(super) spectra: [Spectrum; 2],
}

/// A fit that leaves more than this of a log that it did not see is not what the axis has.
const NOT_CARRIED: f64 = 0.6;
/// How far gains of a control law may be from the scale of its output's column to be one thing.
const ONE_SCALE: f64 = 0.02;

/// Diagnoses a log against a model, and scores what it finds on logs that it does not fit.
#[must_use]
pub fn diagnose(log: AxisLog, model: &AxisModel, unseen: Vec<(String, AxisLog)>) -> AxisDiagnosis {
    let Looked { log, checked, balance, best, mut judged, .. } = Looked::closely(log, model);
    let mut notes = log.notes.clone();
    let unseen: Vec<Vec<Shrunk>> = unseen
        .into_iter()
        .map(|(name, log)| {
            let scores = unseen::score(&balance, &best, model, name.clone(), log, &mut notes);
            // a load that the fitted log did not have is not the fit's to explain: the least that is left counts
            let left = scores.iter().map(|s| 1.0 - 0.01 * s.reduction_percent).fold(f64::MAX, f64::min);
            if !scores.is_empty() && !best.members.is_empty() {
                if left > NOT_CARRIED {
                    notes.push(format!(
                        "what is fitted here does not carry over to {name}: it is not what the axis has"
                    ));
                }
                judged.carried(left.clamp(0.0, 1e3));
            }
            scores
        })
        .collect();
    let motion = &balance.motion;
    let after = balance.residual(&best.members);
    let law = super::law::law_of(&log, &checked, model, &balance.motion);
    judged.doubt_law(law.left);
    if let Some(beat) = super::beat::beat(motion, &after) {
        judged.doubt_beat(beat.share);
        notes.push(format!(
            "what is left beats at {:.2} Hz, which the motion does not ({:.0} % of its power): a force in time, whatever the \
             axis does",
            beat.hz,
            100.0 * beat.share
        ));
    }
    let contribution: Vec<f64> = balance.target.iter().zip(&after).map(|(before, after)| before - after).collect();
    let mut found = judged.found;
    let mut verdict = judged.verdict;
    let scale = found.iter().find(|found| found.effect == "torque_scale").map(|found| found.parameters[0].value);
    found.extend(law.found.into_iter().filter(|own| !scale.is_some_and(|scale| of_one_scale(own, scale))));
    if !found.is_empty() && verdict == Verdict::NoGap {
        verdict = Verdict::Explained;
    }
    for fault in &checked.faults {
        found.insert(0, of_column(fault));
    }
    if !checked.faults.is_empty() && verdict == Verdict::NoGap {
        verdict = Verdict::Explained;
    }
    let mut blocks: Vec<(String, f64)> = Vec::new();
    let balanced = || found.iter().filter(|found| found.shows_in == "effort");
    let all: f64 = balanced().map(|found| found.removes).sum::<f64>().max(1e-300);
    for found in balanced() {
        match blocks.iter_mut().find(|(name, _)| name == found.block) {
            Some((_, share)) => *share += found.removes / all,
            None => blocks.push((found.block.to_owned(), found.removes / all)),
        }
    }
    blocks.sort_by(|a, b| b.1.total_cmp(&a.1));
    let gap = verdict != Verdict::NoGap;
    let mut shrunk = vec![judged.shrunk];
    shrunk.extend(law.shrunk);
    let mut words = checked.words;
    words.extend(law.words);
    shrunk.extend(unseen.into_iter().flatten());
    notes.extend(remarks(&found, model, &balance));
    notes.extend(judged.crumbs.iter().map(|crumb| {
        format!(
            "{} takes {:.1} % of the gap's power beside them, as another make of what is named may do: fitted, not named",
            crumb.effect,
            100.0 * crumb.removes
        )
    }));
    notes.extend(offset_instead(&balance, &best, model));
    let lines = Lines {
        time_s: motion.rows.iter().map(|&row| log.first_s + motion.time_s(row)).collect(),
        effort: balance.effort.clone(),
        nominal: balance.effort.iter().zip(&balance.target).map(|(u, r)| u - r).collect(),
        fitted: balance.effort.iter().zip(&after).map(|(u, r)| u - r).collect(),
    };
    AxisDiagnosis {
        rows: log.rows,
        period_s: log.period_s,
        first_s: log.first_s,
        band_hz: motion.band_hz,
        effort_unit: model.effort_unit.clone(),
        position_unit: model.motion.unit(),
        verdict,
        found,
        ranking: judged.ranking,
        alternatives: judged.alternatives,
        unknown_probability: judged.unknown_probability,
        blocks,
        regimes: if gap { regimes(motion, &balance.target, &after) } else { Vec::new() },
        bands: if gap { bands(motion, &balance.target) } else { Vec::new() },
        spans: if gap && !best.members.is_empty() { spans(motion, &contribution, rms(&after)) } else { Vec::new() },
        shrunk,
        detectable: detectable(&balance, &best, &after),
        columns: words,
        notes,
        curve: friction_curve(&balance, &best, &judged.drawn, model),
        lines,
        spectra: [spectrum(motion, &balance.target), spectrum(motion, &after)],
    }
}

/// Whether what is found in the control law is the scale of its output's column.
fn of_one_scale(own: &Found, scale: f64) -> bool {
    let change = own.parameters.iter().find(|parameter| parameter.name == "relative_change");
    own.effect == "loop_gain" && change.is_some_and(|change| (change.value - scale).abs() < ONE_SCALE)
}

fn of_column(fault: &ColumnFault) -> Found {
    let parameters = fault
        .parameters
        .iter()
        .map(|(name, value, std, unit)| Parameter {
            name: (*name).to_owned(),
            value: *value,
            std: *std,
            unit: unit.clone(),
        })
        .collect();
    Found {
        effect: fault.effect.to_owned(),
        block: "measurement",
        probability: 0.98,
        parameters,
        removes: 0.0,
        shows_in: "columns",
    }
}

/// What these signals cannot tell apart, whatever their size, and what would.
fn remarks(found: &[Found], model: &AxisModel, balance: &Balance) -> Vec<String> {
    let named = |effect: &str| found.iter().any(|found| found.effect == effect);
    let mut notes = Vec::new();
    if named("constant_torque") && !model.trusts("torque_bias") {
        notes.push(
            "constant_torque may as well be torque_bias, an offset of the effort's sensor or drive, or gravity; told apart \
             by a run with the axis turned round, or by the effort logged with the drive off"
                .to_owned(),
        );
    }
    if found.iter().any(|found| found.effect == "torque_ripple" && is_one_a_turn(found)) {
        notes.push(
            "torque_ripple of one wave a turn is what gravity does to an arm whose axis is not upright".to_owned(),
        );
    }
    if named("torque_scale") {
        notes.push(
            "torque_scale is a common factor of inertia and friction: the force constant, or all of them; told apart by a \
             known mass added to the axis"
                .to_owned(),
        );
    }
    if named("motor_lag") {
        notes.push("motor_lag may as well be loop_delay or time_skew of this size; told apart by a probe near the lag's corner".to_owned());
    }
    if named("inertia") && !named("torque_scale") && named("viscous_friction") {
        notes.push(
            "inertia and viscous friction shift together: a wrong scale of position or time would do the same"
                .to_owned(),
        );
    }
    if !balance.hidden.is_empty() {
        notes.push(format!("this log cannot show: {}", balance.hidden.join(", ")));
    }
    notes
}

/// Whether a ripple has one wave a turn, but for what an arm that is itself moved adds.
fn is_one_a_turn(found: &Found) -> bool {
    found.parameters.iter().any(|own| own.name == "waves_per_turn" && (own.value - 1.0).abs() < ONE_A_TURN)
}

/// What an offset would leave in the place of friction that is larger one way: at one speed they are one.
fn offset_instead(balance: &Balance, best: &Set, model: &AxisModel) -> Option<String> {
    let candidates = &balance.problem.candidates;
    let place = best.members.iter().position(|&member| candidates[member].shape == Shape::DragAsymmetry)?;
    let mut members = best.members.clone();
    members[place] = candidates.iter().position(|candidate| candidate.shape == Shape::Constant)?;
    let (columns, amplitudes) = balance.fit(&members);
    let offset = columns.iter().position(|column| *column == candidates[members[place]].columns[0])?;
    Some(format!(
        "constant_torque of {:.3e} {unit} in the place of direction_asymmetry would leave {:.3e} {unit} rms, not {:.3e}",
        amplitudes[offset],
        rms(&balance.residual(&members)),
        rms(&balance.residual(&best.members)),
        unit = model.effort_unit
    ))
}

/// Smallest amplitude of each kind that would have been seen.
fn detectable(balance: &Balance, best: &Set, after: &[f64]) -> Vec<(String, Option<f64>)> {
    let problem = &balance.problem;
    let beside = problem.columns(&best.members);
    let lag = 1 + 2 * super::balance::correlation(after);
    let variance = rms(after).powi(2).max(balance.motion.floor.powi(2)) * lag as f64;
    let mut sizes: Vec<(String, Option<f64>)> = Vec::new();
    // sizes of one effect are in one unit
    for candidate in problem.candidates.iter().filter(|candidate| candidate.shape != Shape::DragAsymmetry) {
        // a nominal parameter stands in the balance already, and is an effect beyond its tolerance
        let base = NOMINAL.iter().position(|nominal| *nominal == candidate.shape);
        let column = base.unwrap_or(candidate.columns[0]);
        let others: Vec<usize> = beside.iter().copied().filter(|other| !candidate.columns.contains(other)).collect();
        let kept = problem.grams.keeps(column, &others) * problem.grams.power(column);
        let known = base.map_or(0.0, |base| problem.within[base]);
        let size = (kept > 0.0).then(|| known + 5.0 * (variance / kept).sqrt());
        let effect = super::judge::label(&candidate.shape, &balance.motion);
        match sizes.iter_mut().find(|(name, _)| *name == effect) {
            Some((_, old)) => *old = old.zip(size).map(|(a, b)| a.min(b)).or(size),
            None => sizes.push((effect, size)),
        }
    }
    sizes.extend(balance.hidden.iter().map(|effect| ((*effect).to_owned(), None)));
    sizes
}
