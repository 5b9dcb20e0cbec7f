//! What effort, command and references say by themselves: a drive that is not measured, a limit, what is stuck, and how the
//! axis follows.

use gimbal_model_file::AxisModel;

use super::follows::follows;
use super::library::rms;
use super::noise::step;
use super::smooth::Kernel;
use super::table::AxisLog;

/// Share of a column that roundings of two formulas leave.
const EXACT: f64 = 1e-5;
/// An effort is beyond its drive's limit from this share of it on, and at a limit for that many rows and that share of all
/// at least.
const BEYOND_LIMIT: f64 = 1.01;
const LEAST_AT_LIMIT: usize = 8;
const SHARE_AT_LIMIT: f64 = 2e-3;
/// What does not change for so long is at rest, or stuck [s].
const STUCK_S: f64 = 0.2;
/// Smoothing of a position whose rate is not logged [rows].
const RATE_ROWS: f64 = 3.0;

/// How the effort follows the command.
pub(super) fn drive(log: &AxisLog, model: &AxisModel) -> Vec<String> {
    let (Some(command), Some(source)) = (&log.command, &model.columns.command) else { return Vec::new() };
    let name = &model.columns.effort.name;
    let both = follows(command, &log.effort, &log.valid);
    let mut words = vec![format!(
        "`{name}` is {:.5} times `{}` (correlation {:.5}, {:.2} ms late)",
        both.slope,
        source.name,
        both.correlation,
        both.late_rows * 1e3 * log.period_s
    )];
    let left = rms(&log.effort) * (1.0 - both.correlation.powi(2)).max(0.0).sqrt();
    if left < step(&log.effort).max(EXACT * rms(&log.effort)) {
        words.push(format!("`{name}` is the command times a constant, not a measurement: the drive is not seen"));
    }
    words
}

/// An effort that stays at its largest, or goes beyond that of its drive.
pub(super) fn limit(log: &AxisLog, model: &AxisModel) -> Option<String> {
    let (name, unit) = (&model.columns.effort.name, &model.effort_unit);
    let most = log.effort.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    if let Some(limit) = model.effort_limit.filter(|limit| most > BEYOND_LIMIT * limit) {
        let beyond = log.effort.iter().filter(|u| u.abs() > BEYOND_LIMIT * limit).count();
        return Some(format!(
            "`{name}` goes up to {most:.4} {unit}, beyond `effort_limit` ({limit:.4} {unit}) in {beyond} of {} rows: its unit, \
             its `scale` or the limit is another",
            log.effort.len()
        ));
    }
    let limit = model.effort_limit.unwrap_or(most).min(most);
    let at_limit = log.effort.windows(2).filter(|p| p[0].abs() >= 0.999 * limit && p[1].abs() >= 0.999 * limit).count();
    let share = at_limit as f64 / log.effort.len() as f64;
    (at_limit >= LEAST_AT_LIMIT && share > SHARE_AT_LIMIT)
        .then(|| format!("`{name}` stays at {limit:.4} {unit} for {:.1} % of the rows: a limit", 100.0 * share))
}

/// Channels that stay at one value.
pub(super) fn stuck(log: &AxisLog, model: &AxisModel) -> Vec<String> {
    let names = &model.columns;
    let motion = [(log.position.as_ref(), names.position.as_ref()), (log.velocity.as_ref(), names.velocity.as_ref())];
    let channels = motion.into_iter().chain([(Some(&log.effort), Some(&names.effort))]);
    let told = channels.filter_map(|(values, source)| {
        let (values, source) = (values?, source?);
        let mut longest = 0;
        let mut run = 0;
        for pair in values.windows(2) {
            run = if pair[0].to_bits() == pair[1].to_bits() { run + 1 } else { 0 };
            longest = longest.max(run);
        }
        let length_s = f64::from(longest) * log.period_s;
        (length_s > STUCK_S)
            .then(|| format!("`{}` does not change for {length_s:.2} s: at rest, or stuck", source.name))
    });
    told.collect()
}

/// How the axis follows its references.
pub(super) fn references(log: &AxisLog, model: &AxisModel) -> Vec<String> {
    let names = &model.columns;
    let rate = match (&log.velocity, &log.position) {
        (Some(velocity), _) => Some(velocity.clone()),
        (None, Some(position)) => Some(Kernel::new(RATE_ROWS, 1, log.period_s).apply(position)),
        _ => None,
    };
    let pairs = [
        (&log.position_reference, &log.position, &names.position_reference),
        (&log.velocity_reference, &rate, &names.velocity_reference),
    ];
    let told = pairs.into_iter().filter_map(|(reference, measured, source)| {
        let (reference, measured, source) = (reference.as_ref()?, measured.as_ref()?, source.as_ref()?);
        let both = follows(reference, measured, &log.valid);
        Some(format!(
            "the axis follows `{}` with a gain of {:.4} (correlation {:.3})",
            source.name, both.slope, both.correlation
        ))
    });
    told.collect()
}
