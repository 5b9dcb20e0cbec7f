//! The whole way from a log to a diagnosis.

use gimbal_log::Log;
use gimbal_model_file::ModelFile;

use crate::fit::{Fit, Known, Tried, without};
use crate::judge::{
    Correlation, CurvePoint, Decision, Detectable, Portrait, Shrink, Spread, Verdict, Yardstick, bounds_hit,
    contradicted, correlations, curve, decide, detectable, free_running, one_step, portrait, shrink, slow_noise,
};
use crate::mistake::mistaken;
use crate::place::{Band, Regime, Span, Spectrum, block_shares, regimes, spans};
use crate::record::{BEGINNING_S, Data, Record, faults};
use crate::settle::{Measured, Settled, settled};
use crate::shake::shaken;
use crate::still::{at_rest, closest_as_balanced};
use crate::touch::touched;

/// No fit that leaves more than this of the noise comes near a log.
const ASTRAY: f64 = 1.5;

/// Rows in which a beginning that is not the platform's shows most, and how far beyond chance [s], [standard deviations].
const FIRST_S: f64 = 0.1;
const FIRST_STANDS_OUT: f64 = 6.0;

/// Everything that a report says about one log.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// Log as read.
    pub record: Record,
    /// Verdict; none when the data do not serve.
    pub decision: Option<Decision>,
    /// Shares of the blocks.
    pub blocks: Vec<(String, f64)>,
    /// Shares of the bands.
    pub bands: Vec<Band>,
    /// Shares of the regimes.
    pub regimes: Vec<Regime>,
    /// When.
    pub spans: Vec<Span>,
    /// What each effect takes away.
    pub removes: Vec<f64>,
    /// Before and after.
    pub shrink: Option<Shrink>,
    /// Smallest sizes.
    pub detectable: Vec<Detectable>,
    /// Spectra of the residual: nominal and fitted, channel by channel.
    pub spectra: [Vec<Spectrum>; 2],
    /// Measured less predicted, nominal and fitted, channel by channel; after a stop from the state that the log shows.
    pub residuals: [Vec<Vec<f64>>; 2],
    /// The fit that was chosen, or that of the nominal parameters.
    pub fit: Option<Fit>,
    /// What is left, where something is.
    pub portrait: Option<Portrait>,
    /// The reference plant, free, before and after.
    pub free_running: Vec<Yardstick>,
    /// One step ahead, before and after.
    pub one_step: Vec<Yardstick>,
    /// Fitted values that move together.
    pub correlations: Vec<Correlation>,
    /// Values at the end of their range.
    pub bounds_hit: Vec<String>,
    /// Effects that were not looked for.
    pub not_looked_for: Vec<&'static str>,
    /// Friction over the rate.
    pub curve: Vec<CurvePoint>,
    /// What other logs are asked about; none when the data do not serve.
    pub(crate) asked: Option<Asked>,
}

/// What it takes to go on with a log beside others.
#[derive(Debug, Clone)]
pub(crate) struct Asked {
    /// What the noise was taken from; none is what the nominal parameters and a few effects do not explain.
    pub(crate) known: Option<Known>,
    /// The noise that the best fit leaves, over that of the sensors.
    pub(crate) temper: f64,
    /// The nominal parameters alone, then every set that was fitted.
    pub(crate) tried: Vec<Tried>,
}

impl Diagnosis {
    /// The verdict.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.decision.as_ref().map_or(Verdict::CannotTell, |decision| decision.verdict)
    }
}

/// Diagnoses one log against a model.
#[must_use]
#[allow(clippy::too_many_lines, reason = "the way, told in its order")]
pub fn diagnose(log: &Log, model: &ModelFile) -> Diagnosis {
    let mut read = Record::new(log, &model.config);
    if !read.faults.is_empty() {
        return refused(read);
    }
    let doubt = match faults(&read, model) {
        Data::Sound => None,
        Data::Faulty(told) => {
            read.faults = told;
            return refused(read);
        }
        Data::Doubtful(told, undone) => Some((told, undone)),
    };
    read.quieten(&crate::library::platform(model));
    let mut on = Measured::new(&read, model);
    if let Some(inputs) = at_rest(&on.problem, &on.nominal) {
        drop(on);
        read.stands_still(inputs);
        on = Measured::new(&read, model);
    }
    // the sooner, the less is fitted with a noise of the rate that is not all
    let mut is_shaken = false;
    if on.is_near()
        && let Some(by) = shaken(&on.problem, &on.nominal)
    {
        drop(on);
        read.is_shaken(by.motor_nm, by.rate_radps);
        is_shaken = true;
        on = Measured::new(&read, model);
    }
    let mut whole = on.settled();
    // hum that the gap hid
    if let Some(hushed) = read.hushed(&whole.search.closest().prediction) {
        drop(whole);
        read = hushed;
        whole = settled(&read, model);
    }
    if let Some(inputs) = at_rest(&whole.problem, closest_as_balanced(&whole.search)) {
        drop(whole);
        read.stands_still(inputs);
        whole = settled(&read, model);
    }
    if !is_shaken
        && let Some(by) = shaken(&whole.problem, whole.search.closest())
        && (by.rate_radps > 0.0 || whole.search.fits.iter().any(|fit| fit.physics.has_corners()))
    {
        drop(whole);
        read.is_shaken(by.motor_nm, by.rate_radps);
        whole = settled(&read, model);
    }
    if let Some(touched) = touched(&whole) {
        drop(whole);
        read.touches(touched.level_rad, &touched.on_stop);
        whole = settled(&read, model);
    }
    let mut imitated = None;
    if let Some((told, undone)) = doubt {
        if mistaken(&whole, *undone, model) {
            drop(whole);
            read.faults.push(told);
            return refused(read);
        }
        imitated = Some(format!("{told}; what the library has explains the log better as it is"));
    }
    let bearing = &model.config.bearing;
    let rested = read.without_rests().filter(|_| leaves_something(&whole, model));
    let without_rests = rested.is_some();
    let part = if without_rests {
        rested
    } else if read.comes_near_a_stop() {
        astray(&whole).then(|| read.away_from_stop(bearing)).flatten()
    } else {
        begins_wrong(&whole).then(|| read.after_its_beginning(bearing)).flatten()
    };
    let mut in_part = part.is_some();
    let Settled { mut problem, mut search, known } = match &part {
        Some(part) => {
            let left = left_of(&whole);
            // two at once would be twice the memory, and a part that is no better is rare
            drop(whole);
            let own = settled(part, model);
            in_part = if without_rests { !leaves_something(&own, model) } else { left_of(&own) < left };
            if in_part {
                own
            } else {
                drop(own);
                settled(&read, model)
            }
        }
        None => whole,
    };
    let record = problem.record;
    let tried = [&search.null].into_iter().chain(&search.fits).map(|fit| Tried::new(&problem, fit)).collect();
    let asked = Asked { known, temper: search.temper(&problem), tried };
    let mut decision = decide(&problem, &search, &model.tolerance);
    decision.notes.extend(imitated);
    decision.notes.extend(slow_noise(&problem));
    let channels = record.channels.len();
    let mut fit = match decision.chosen {
        Some(index) => search.fits.swap_remove(index),
        None => search.null.clone(),
    };
    let mut shrink = shrink(&problem, &fit);
    let chosen = decision.chosen.is_some();
    if contradicted(&mut decision, &shrink) && chosen {
        shrink = crate::judge::shrink(&problem, &search.null);
        fit = search.null;
    }
    let period_s = record.inputs.period_s;
    let [before, after] = [&shrink.nominal, &fit.prediction].map(|prediction| problem.residual(prediction));
    let spectra = [&before, &after].map(|residual| {
        let of = |place: usize| {
            Spectrum::new(&residual[place], &record.channels[place].valid, problem.noise[place], period_s)
        };
        (0..channels).map(of).collect::<Vec<_>>()
    });
    let contributions: Vec<Vec<f64>> = (0..fit.set.0.len()).map(|place| without(&problem, &fit, place)).collect();
    let total: Vec<f64> = match contributions.split_first() {
        Some((first, rest)) => {
            let mut total = first.clone();
            for contribution in rest {
                total.iter_mut().zip(contribution).for_each(|(total, value)| *total += value);
            }
            total
        }
        None => fit.residual.clone(),
    };
    let power = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let all: f64 = contributions.iter().map(|contribution| power(contribution)).sum::<f64>().max(1e-30);
    let gone = 1.0 - decision.left_over[1] / decision.left_over[0].max(decision.left_over[1]).max(1e-9);
    let removes: Vec<f64> =
        contributions.iter().map(|c| (power(c) / all * gone.clamp(0.0, 1.0)).clamp(0.0, 1.0)).collect();
    let blocks = if fit.set.0.is_empty() {
        if decision.verdict == Verdict::NoGap { Vec::new() } else { block_shares(&problem, &fit.residual) }
    } else {
        let mut shares: Vec<(String, f64)> = Vec::new();
        for (place, &index) in fit.set.0.iter().enumerate() {
            let block =
                gimbal_plant::Effect::from_name(problem.candidates[index].effect).map(|e| e.block().to_string());
            let share = power(&contributions[place]) / all;
            let block = block.unwrap_or_default();
            match shares.iter_mut().find(|(name, _)| *name == block) {
                Some((_, sum)) => *sum += share,
                None => shares.push((block, share)),
            }
        }
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        shares
    };
    let gap = decision.verdict != Verdict::NoGap;
    let left = matches!(decision.verdict, Verdict::PartlyExplained | Verdict::Unexplained);
    let (free_running, (portrait, detectable, spread, curve)) = rayon::join(
        || if gap { free_running(record, model, &decision, &fit) } else { Vec::new() },
        || {
            let portrait = left.then(|| portrait(&problem, &fit));
            let detectable = detectable(&problem, &fit, &decision, &model.tolerance);
            (portrait, detectable, Spread::new(&problem, &fit), curve(&problem, &fit, &shrink.nominal))
        },
    );
    if let Some(spread) = &spread {
        spread.widen(&mut decision.found);
    }
    let correlations = spread.as_ref().map_or_else(Vec::new, correlations);
    let bounds_hit = bounds_hit(&problem, &fit);
    let one_step = if gap { one_step(record, &before, &after) } else { Vec::new() };
    let found_regimes = if gap { regimes(record, &fit.prediction, &total, channels) } else { Vec::new() };
    let found_spans = if gap && !fit.set.0.is_empty() { spans(&total, channels, period_s) } else { Vec::new() };
    let bands = if gap { Spectrum::bands(&spectra[0]) } else { Vec::new() };
    let not_looked_for = std::mem::take(&mut problem.not_looked_for);
    drop(problem);
    Diagnosis {
        record: part.filter(|_| in_part).unwrap_or(read),
        decision: Some(decision),
        blocks,
        bands,
        regimes: found_regimes,
        spans: found_spans,
        removes,
        shrink: Some(shrink),
        detectable,
        spectra,
        residuals: [before, after],
        fit: Some(fit),
        portrait,
        free_running,
        one_step,
        correlations,
        bounds_hit,
        not_looked_for,
        curve,
        asked: Some(asked),
    }
}

/// Whether what it finds leaves something of the log.
fn leaves_something(Settled { problem, search, .. }: &Settled, model: &ModelFile) -> bool {
    let verdict = decide(problem, search, &model.tolerance).verdict;
    matches!(verdict, Verdict::PartlyExplained | Verdict::Unexplained)
}

/// Whether nothing that was tried comes near the log: a way through the stop decides all that follows it.
fn astray(settled: &Settled) -> bool {
    left_of(settled) > ASTRAY
}

/// What the closest fit leaves of the noise.
fn left_of(Settled { problem, search, .. }: &Settled) -> f64 {
    search.closest().square / problem.whitener.count().max(1) as f64
}

/// Whether its first rows stand out of what the closest fit leaves: from where the log shows the platform to begin, no
/// prediction gets to where it was.
fn begins_wrong(whole @ Settled { problem, search, .. }: &Settled) -> bool {
    let closest = search.closest();
    let square_of = |length_s: f64| {
        let values = problem.record.inputs.rows_of(length_s) * problem.record.channels.len();
        (closest.residual.iter().take(values).map(|value| value * value).sum::<f64>(), values as f64)
    };
    let (first, values) = square_of(FIRST_S);
    let count = problem.whitener.count() as f64;
    let elsewhere = (closest.square - first) / (count - values).max(1.0);
    let stands_out = (first / elsewhere - values) / (2.0 * values).sqrt() > FIRST_STANDS_OUT;
    let (first, values) = square_of(BEGINNING_S);
    stands_out || astray(whole) && first - values > 0.5 * (closest.square - count)
}

fn refused(record: Record) -> Diagnosis {
    Diagnosis {
        record,
        decision: None,
        blocks: Vec::new(),
        bands: Vec::new(),
        regimes: Vec::new(),
        spans: Vec::new(),
        removes: Vec::new(),
        shrink: None,
        detectable: Vec::new(),
        spectra: [Vec::new(), Vec::new()],
        residuals: [Vec::new(), Vec::new()],
        fit: None,
        portrait: None,
        free_running: Vec::new(),
        one_step: Vec::new(),
        correlations: Vec::new(),
        bounds_hit: Vec::new(),
        not_looked_for: Vec::new(),
        curve: Vec::new(),
        asked: None,
    }
}
