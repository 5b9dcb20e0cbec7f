//! A search under a noise that its best fit does not stay below: one that does says that the noise was taken too high,
//! and that what an effect did, or what the nominal parameters could not take away at once, was in it.
//!
//! Where a first look at the library shows that, the noise is measured again at once, from what its best fit leaves, and
//! once more where the same effects still stay below it. The whole search is for the noise that stands.

use gimbal_model_file::ModelFile;

use crate::fit::{Effort, Fit, Ground, Known, Problem, Search, Set, ended, is_near, look, null, refine};
use crate::record::Record;

/// A fit may leave this much of the noise that was expected, and no less.
const TOO_QUIET: f64 = 0.98;
/// How sure it must be that noise of low frequency was taken too high: few lines that hide what is slow, and thirty parameters
/// take some of it [nats].
const TOO_HIGH: f64 = 12.0;
/// How often the noise is taken again; and how often from a whole search that leaves far less, as single effects were all that
/// it was taken from.
const AGAIN: usize = 2;
const AT_LAST: usize = 2;
const FAR_TOO_HIGH: f64 = 300.0;

/// A search whose noise stands.
pub(crate) struct Settled<'a> {
    pub(crate) problem: Problem<'a>,
    pub(crate) search: Search,
    /// What the noise was taken from; none is what the nominal parameters and a few effects do not explain.
    pub(crate) known: Option<Known>,
}

/// The search whose noise stands.
pub(crate) fn settled<'a>(record: &'a Record, model: &'a ModelFile) -> Settled<'a> {
    Measured::new(record, model).settled()
}

/// A problem under a noise, by the sensitivities at the fit of the nominal parameters.
pub(crate) struct Measured<'a> {
    model: &'a ModelFile,
    ground: Ground<'a>,
    known: Option<Known>,
    pub(crate) problem: Problem<'a>,
    /// That fit.
    pub(crate) nominal: Fit,
    /// What left this noise, fitted under it.
    carried: Option<Fit>,
    /// How often the noise may be taken again, and how often beyond that from a whole search.
    more: usize,
    last: usize,
    /// Square that the fit which left this noise leaves under it; endless where that is not known.
    stands_at: f64,
}

impl<'a> Measured<'a> {
    /// The nominal parameters, fitted under the noise that they leave.
    pub(crate) fn new(record: &'a Record, model: &'a ModelFile) -> Self {
        let ground = Ground::new(record, model);
        let mut problem = ground.problem(None);
        let mut nominal = null(&mut problem, None);
        let known = if is_near(&problem, &nominal) { ground.known_behind(&nominal) } else { None };
        if known.is_some() {
            problem = ground.problem(known.clone());
            nominal = null(&mut problem, Some(&nominal));
        }
        let (more, last) = (AGAIN, AT_LAST);
        Self { model, ground, known, problem, nominal, carried: None, more, last, stands_at: f64::INFINITY }
    }

    /// Whether the nominal parameters come near the noise.
    pub(crate) fn is_near(&self) -> bool {
        is_near(&self.problem, &self.nominal)
    }

    /// The search from here, once more under each noise that did not stand.
    pub(crate) fn settled(self) -> Settled<'a> {
        let mut on = if self.is_beaten_by(&self.nominal) { self.under_less() } else { self };
        loop {
            on.complete();
            let mut looked = look(&on.problem, on.nominal.clone(), on.carried.take());
            let mut beaten = on.may_be_beaten_by(looked.closest());
            // pairs are for a noise that no single effect stays below
            if !beaten {
                looked = looked.widened(&mut on.problem);
                beaten = on.may_be_beaten_by(looked.closest());
            }
            let best = if beaten {
                let best = looked.closest().clone();
                drop(looked);
                ended(&mut on.problem, best)
            } else {
                let search = looked.finished(&mut on.problem);
                let beaten = on.may_be_beaten_by(search.closest()) || on.is_beaten_at_last(search.closest());
                if !beaten {
                    return Settled { problem: on.problem, search, known: on.known };
                }
                let best = search.closest().clone();
                on.nominal = search.null;
                best
            };
            on = on.again_until_it_stands(best);
        }
    }

    /// Under the noise that the nominal parameters leave, or a first look: near the noise, and at the end of their tolerance, they
    /// stand for an effect.
    fn under_less(mut self) -> Self {
        let mut best = self.nominal.clone();
        if self.is_near() && best.is_strained(&self.problem) {
            self.complete();
            best = look(&self.problem, best, None).widened(&mut self.problem).closest().clone();
            best = ended(&mut self.problem, best);
        }
        self.again(&best)
    }

    /// Ready for a look through the library.
    fn complete(&mut self) {
        self.ground.complete(&mut self.problem);
    }

    /// Whether a fit leaves less than the noise.
    fn is_beaten_by(&self, fit: &Fit) -> bool {
        let whitener = &self.problem.whitener;
        fit.square < TOO_QUIET * whitener.count() as f64
            || whitener.too_high(&fit.residual, self.problem.record.inputs.period_s) > TOO_HIGH
    }

    /// The same, as long as the noise may be measured again and would not be what it is.
    fn may_be_beaten_by(&self, fit: &Fit) -> bool {
        self.more > 0 && fit.square < self.stands_at - 2.0 * TOO_HIGH && self.is_beaten_by(fit)
    }

    /// Whether a whole search under the last noise leaves far less; it may be taken again then.
    fn is_beaten_at_last(&mut self, fit: &Fit) -> bool {
        let too_high = || self.problem.whitener.too_high(&fit.residual, self.problem.record.inputs.period_s);
        let beaten = self.more == 0 && self.last > 0 && fit.effects.len() > 1 && too_high() > FAR_TOO_HIGH;
        if beaten {
            (self.more, self.last) = (1, self.last - 1);
            self.ground = Ground::new(self.problem.record, self.model);
        }
        beaten
    }

    /// Under the noise that a fit leaves.
    fn again(self, best: &Fit) -> Self {
        let Self { model, ground, problem, nominal, more, last, .. } = self;
        let raw = |fit: &Fit| problem.residual(&fit.prediction);
        let known = Some(Known { noise: raw(best), gap: raw(&nominal), platform: best.into() });
        // what is not needed any more is most of the memory
        drop(problem);
        let mut problem = ground.problem(known.clone());
        let nominal = null(&mut problem, Some(&nominal));
        Self { model, ground, known, problem, nominal, carried: None, more, last, stands_at: f64::INFINITY }
    }

    /// Once more, and again where the same effects stay below that noise too.
    fn again_until_it_stands(self, mut best: Fit) -> Self {
        let mut on = self;
        loop {
            on = on.again(&best);
            on.more -= 1;
            on.carried = carried(&on.problem, &best);
            if on.more == 0 {
                on.complete();
                on.ground.forget();
                return on;
            }
            let Some(still) = &on.carried else { return on };
            if !on.is_beaten_by(still) {
                on.stands_at = still.square;
                return on;
            }
            best = still.clone();
        }
    }
}

/// A fit under another noise, if its effects are looked for there.
fn carried(problem: &Problem, fit: &Fit) -> Option<Fit> {
    let place = |effect: &&str| problem.candidates.iter().position(|candidate| candidate.effect == *effect);
    let set = Set(fit.effects.iter().map(place).collect::<Option<_>>()?);
    Some(refine(problem, &set, &fit.values, Some(fit), Effort::Full))
}
