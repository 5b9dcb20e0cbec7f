//! A log of an axis as it is looked at: whose column is wrong, and in which band.

use gimbal_model_file::AxisModel;

use super::balance::Balance;
use super::columns::{Checked, ColumnFault};
use super::judge::{Found, Judged, judge};
use super::library::rms;
use super::motion::Motion;
use super::ready::ready;
use super::search::Set;
use super::table::AxisLog;
use crate::judge::Verdict;

/// Bands that are tried where noise hides effects: each is this share of the one before.
const NARROWER: f64 = 0.6;
const NARROWINGS: usize = 4;
/// Rows that a band must leave.
const LEAST_ROWS: usize = 100;
/// Share of the effort from which on noise hides what a narrower band shows.
const HIDES: f64 = 0.02;
/// Which of its columns is wrong where position and rate differ by a factor.
const SCALES: [&str; 3] = ["position_scale", "velocity_scale", "time_scale"];

/// A log as it is looked at in one band.
pub(super) struct Looked {
    /// The model as it was looked at with: columns that are taken for right among what is known good.
    model: AxisModel,
    pub(super) log: AxisLog,
    pub(super) checked: Checked,
    pub(super) balance: Balance,
    pub(super) best: Set,
    pub(super) judged: Judged,
}

impl Looked {
    fn new(log: AxisLog, model: AxisModel) -> Self {
        let made = ready(log, &model);
        Self::of(made, model)
    }

    fn of((log, checked, motion): (AxisLog, Checked, Motion), model: AxisModel) -> Self {
        let (balance, best) = Balance::searched(motion, &model);
        let judged = judge(&balance, &best, &model);
        Self { model, log, checked, balance, best, judged }
    }

    /// In the widest band that its noise allows, or closer.
    pub(super) fn closely(log: AxisLog, model: &AxisModel) -> Self {
        let (wide, instead) = Self::whichever_scale(&log, model);
        let narrower = if wide.judged.verdict == Verdict::NoGap { wide.beneath(&log) } else { wide.narrowed(&log) };
        let mut closest = narrower.unwrap_or(wide);
        closest.checked.words.extend(instead);
        closest
    }

    /// Which column's scale is wrong, the nominal parameters tell as they are; where effects stand beside them, it may be
    /// another one that explains the log with fewer. And what is told of it then.
    fn whichever_scale(log: &AxisLog, model: &AxisModel) -> (Self, Option<String>) {
        let first = Self::new(log.clone(), model.clone());
        let of_scale = |fault: &&ColumnFault| SCALES.contains(&fault.effect);
        let told = first.checked.faults.iter().find(of_scale).map(|fault| fault.effect);
        let Some(told) = told.filter(|_| first.effects() > 0) else { return (first, None) };
        let others = SCALES.into_iter().filter(|scale| *scale != told && !model.trusts(scale));
        let mut best = (first, None);
        for scale in others {
            let known_good = SCALES.iter().filter(|other| **other != scale).map(|other| (*other).to_owned());
            let known_good = model.known_good.iter().cloned().chain(known_good).collect();
            let other = Self::new(log.clone(), AxisModel { known_good, ..model.clone() });
            if other.judged.verdict != Verdict::Unexplained && other.effects() < best.0.effects() {
                best = (other, Some(format!("with `{scale}` in the place of `{told}` it takes fewer effects")));
            }
        }
        best
    }

    /// In a narrower band, where effects explain it there, no more of them, that noise hides in this one.
    fn narrowed(&self, log: &AxisLog) -> Option<Self> {
        let hidden = &self.balance.hidden;
        if self.model.band_hz.is_some() || hidden.is_empty() {
            return None;
        }
        let most = if self.judged.verdict == Verdict::Unexplained { usize::MAX } else { self.judged.found.len() };
        let better = |narrow: &Self| narrow.judged.found.len() <= most && narrow.explains_by(hidden);
        self.closer(log).find(better)
    }

    /// Where nothing stands out of a wide band's noise, which is a notable part of the effort: the first narrower one in which
    /// something does, if the next says the same of it.
    fn beneath(&self, log: &AxisLog) -> Option<Self> {
        let motion = &self.balance.motion;
        if self.model.band_hz.is_some() || motion.floor < HIDES * rms(&motion.pick(&motion.effort)) {
            return None;
        }
        let mut last: Option<Self> = None;
        for closer in self.closer(log) {
            if let Some(first) = last.take_if(|first| first.names() == closer.names()) {
                return Some(first);
            }
            last = Some(closer).filter(|closer| closer.judged.verdict == Verdict::Explained && !closer.is_rough());
        }
        None
    }

    /// Whether something of it is never quite as it is formulated.
    fn is_rough(&self) -> bool {
        self.best.members.iter().any(|&member| self.balance.problem.candidates[member].shape.is_rough())
    }

    /// Names of what is found.
    fn names(&self) -> Vec<&str> {
        self.judged.found.iter().map(|found| found.effect.as_str()).collect()
    }

    /// The same log in narrower bands, one after the other, as long as rows are left.
    fn closer<'a>(&'a self, log: &'a AxisLog) -> impl Iterator<Item = Self> + 'a {
        let bands_hz = std::iter::successors(Some(NARROWER * self.balance.motion.band_hz), |hz| Some(NARROWER * hz));
        let narrow = |band_hz| {
            let model = AxisModel { band_hz: Some(band_hz), ..self.model.clone() };
            let made = ready(log.clone(), &model);
            (made.2.rows.len() >= LEAST_ROWS).then(|| Self::of(made, model))
        };
        bands_hz.take(NARROWINGS).map_while(narrow)
    }

    /// Effects of its balance, parameters beyond their tolerance among them.
    fn effects(&self) -> usize {
        self.balance.problem.effects(&self.best.members)
    }

    /// Whether it is explained, and by one of these effects.
    fn explains_by(&self, effects: &[&str]) -> bool {
        let named = |found: &Found| effects.contains(&found.effect.as_str());
        matches!(self.judged.verdict, Verdict::Explained | Verdict::CannotTell) && self.judged.found.iter().any(named)
    }
}
