//! Which effects: single ones, then pairs and triples from the best, each refined before it is judged.

use rayon::prelude::*;

use super::ceiling::saturated;
use super::extension::{Extension, Glimpse, best_by_effect, extensions, glimpses_beside, promising, seen};
use super::formulations::{self, extend, otherwise};
use super::gross::gross;
use super::heavy::heavy;
use super::less::{with_another, with_less};
use super::refine::refined;
use super::refit::rebase;
use super::stiction::{built_up, elsewhere};
use super::walk::{Effort, STILL};
use super::{Fit, Problem, refine};

/// A set of candidates, by index.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Set(pub Vec<usize>);

/// All hypotheses that were refined, the null first.
#[derive(Debug)]
pub struct Search {
    /// Nominal parameters alone.
    pub null: Fit,
    /// Sets, the most probable first.
    pub fits: Vec<Fit>,
    /// Every effect by itself beside the nominal parameters, by the linear equations there, the best first.
    pub glimpses: Vec<Glimpse>,
}

impl Search {
    /// The fit that leaves least.
    #[must_use]
    pub fn closest(&self) -> &Fit {
        closest(&self.null, &self.fits)
    }

    /// The noise that it leaves, over that of the sensors.
    #[must_use]
    pub fn temper(&self, problem: &Problem) -> f64 {
        problem.formulation(self.closest(), &self.null)
    }
}

/// Refined singles, and refined extensions of each of the best.
const SINGLES: usize = 6;
const EXTENSIONS: usize = 4;
/// What a fit that closes the gap leaves of the noise.
const CLOSED: f64 = 1.02;
/// What one near the noise leaves of it.
const NEAR: f64 = 1.1;
/// What a fit takes away from where on the sensitivities without its effects mislead beside it.
const FAR: f64 = 2e3;
/// How often it is taken further at most, and what of its square it leaves as long as it gets there.
const MOST_TURNS: usize = 5;
const GOES_ON: f64 = 0.95;
/// Share of what a set is behind the best one that an effect more must promise, by the equations linearised.
pub(super) const AS_MUCH: f64 = 0.5;
/// What the shifts of nominal parameters cost that are none any more: what stands for effects so large is no null.
const NOT_NOMINAL: f64 = 1e3;
/// How often sets that are less than the best are tried, while that changes.
const BACKWARDS: usize = 2;
/// Most effects of a set.
const MOST: usize = 3;

/// Looks through the library, from the fit of the nominal parameters alone, by the sensitivities there.
#[must_use]
pub fn search(problem: &mut Problem, null: Fit) -> Search {
    look(problem, null, None).widened(problem).finished(problem)
}

/// Sets of effects that were fitted far enough to be compared.
#[derive(Debug)]
pub(crate) struct Looked {
    null: Fit,
    fits: Vec<Fit>,
    glimpses: Vec<Glimpse>,
    /// What the fit with effects leaves whose sensitivities the problem holds.
    based_at: Option<f64>,
}

/// Single effects, by the sensitivities at the fit of the nominal parameters, beside a fit that is known already.
pub(crate) fn look(problem: &Problem, null: Fit, known: Option<Fit>) -> Looked {
    let (fits, glimpses) = singles(problem, &null, known);
    Looked { null, fits, glimpses, based_at: None }
}

impl Looked {
    /// The fit that leaves least.
    pub(crate) fn closest(&self) -> &Fit {
        closest(&self.null, &self.fits)
    }

    /// Pairs and triples from the best, by the sensitivities there where those of before are far from it.
    pub(crate) fn widened(mut self, problem: &mut Problem) -> Self {
        for size in 1..MOST {
            self.goes_on_from_best(problem);
            widen(problem, &self.null, &mut self.fits, size);
        }
        self
    }

    /// The best fit at its end, and the sensitivities with it, where it is far from the nominal parameters alone.
    fn goes_on_from_best(&mut self, problem: &mut Problem) {
        // after a stop the way through it decides what is far
        if problem.record.comes_near_a_stop() {
            return;
        }
        let Some(best) = self.fits.first_mut().filter(|best| self.null.square - best.square > FAR) else { return };
        for _ in 0..MOST_TURNS {
            if self.based_at == Some(best.square) {
                break;
            }
            let before = best.square;
            rebase(problem, best);
            polish(problem, best);
            if let Some(other) = left_open(problem, best).and_then(|best| elsewhere(problem, best, Effort::Full)) {
                *best = other;
            }
            self.based_at = (before - best.square < STILL).then_some(best.square);
            if best.square > GOES_ON * before {
                break;
            }
        }
        sort(problem, &self.null, &mut self.fits);
    }

    /// The last part: what is close to the best is brought to its end before it is judged.
    pub(crate) fn finished(self, problem: &mut Problem) -> Search {
        let Self { null, mut fits, glimpses, based_at } = self;
        if let Some(best) = fits.first().filter(|best| based_at != Some(best.square)) {
            rebase(problem, best);
        }
        let problem = &*problem;
        let gain = |fit: &Fit| null.square - fit.square;
        let least = fits.first().map_or(0.0, |best| CLOSE * gain(best));
        let close = |(place, fit): &(usize, &mut Fit)| *place < POLISHED && gain(fit) >= least;
        let last: Vec<(usize, &mut Fit)> = fits.iter_mut().enumerate().filter(close).collect();
        last.into_par_iter().for_each(|(_, fit)| polish(problem, fit));
        sort(problem, &null, &mut fits);
        for _ in 0..BACKWARDS {
            let best = fits.first().map(|best| best.set.clone());
            with_less(problem, &mut fits);
            sort(problem, &null, &mut fits);
            with_another(problem, &null, &mut fits);
            sort(problem, &null, &mut fits);
            if best == fits.first().map(|best| best.set.clone()) {
                break;
            }
        }
        let (null, moved) = from_there(problem, null, &fits);
        // what single effects seemed to bring may have been the way that the nominal parameters found meanwhile
        let glimpses = if moved { glimpses_beside(problem, &null) } else { glimpses };
        Search { null, fits, glimpses }
    }
}

/// A fit at its end, by the sensitivities there.
pub(crate) fn ended(problem: &mut Problem, mut fit: Fit) -> Fit {
    if !fit.set.0.is_empty() {
        rebase(problem, &fit);
        polish(problem, &mut fit);
    }
    fit
}

/// Square up to which a fit leaves hardly more than the noise.
pub(crate) fn closed_at(problem: &Problem) -> f64 {
    CLOSED * problem.whitener.count() as f64
}

pub(super) fn is_closed(problem: &Problem, fit: &Fit) -> bool {
    fit.square <= closed_at(problem)
}

/// Whether a fit is near the noise.
pub(crate) fn is_near(problem: &Problem, fit: &Fit) -> bool {
    fit.square < NEAR * problem.whitener.count() as f64
}

/// Whether a fit closes the gap and nothing in the library promises more.
fn is_all(problem: &Problem, fit: &Fit) -> bool {
    is_closed(problem, fit) && !any_promising(problem, &extensions(problem, fit))
}

fn any_promising(problem: &Problem, extensions: &[Extension]) -> bool {
    extensions.iter().any(|extension| promising(problem, extension))
}

fn closest<'a>(null: &'a Fit, fits: &'a [Fit]) -> &'a Fit {
    fits.iter().fold(null, |best, fit| if fit.square < best.square { fit } else { best })
}

/// The nominal parameters alone, from where another fit has them; the sensitivities are taken there.
#[must_use]
pub fn null(problem: &mut Problem, from: Option<&Fit>) -> Fit {
    let (fit, columns) = refined(problem, &Set::default(), &[], from, Effort::Thorough);
    if let Some(other) = left_open(problem, &fit).and_then(|fit| elsewhere(problem, fit, Effort::Thorough)) {
        rebase(problem, &other);
        return other;
    }
    match columns {
        Some(columns) => problem.replace(columns),
        None => rebase(problem, &fit),
    }
    fit
}

/// A fit that leaves more than the noise.
fn left_open<'a>(problem: &Problem, fit: &'a Fit) -> Option<&'a Fit> {
    Some(fit).filter(|fit| !is_closed(problem, fit))
}

/// Single effects, the best first; and what they were chosen from.
fn singles(problem: &Problem, null: &Fit, known: Option<Fit>) -> (Vec<Fit>, Vec<Glimpse>) {
    let mut fits: Vec<Fit> = known.into_iter().filter(|fit| !fit.set.0.is_empty()).collect();
    let first = best_by_effect(problem, extensions(problem, null), usize::MAX);
    let glimpses = seen(&first);
    let near_a_stop = problem.record.comes_near_a_stop();
    let alone = fits.first().filter(|fit| fit.set.0.len() == 1 && !near_a_stop).map(|fit| fit.effects[0]);
    let is_known = |extension: &Extension| alone == Some(problem.candidates[extension.index].effect);
    fits.extend(saturated(problem, null));
    let extended: Vec<(&Extension, Fit)> = first
        .par_iter()
        .take(SINGLES)
        .filter(|extension| promising(problem, extension) && !is_known(extension))
        .filter_map(|extension| Some((extension, formulations::first(problem, null, extension)?)))
        .collect();
    let best = extended.iter().map(|(_, fit)| fit).chain(&fits).min_by(|a, b| a.square.total_cmp(&b.square));
    let all_told = best.filter(|best| is_all(problem, best)).map_or(f64::INFINITY, |best| best.square);
    let otherwise = |(extension, fit): (&Extension, Fit)| {
        if fit.square > all_told { fit } else { otherwise(problem, null, extension, fit) }
    };
    fits.par_extend(extended.into_par_iter().map(otherwise));
    if !fits.iter().any(|fit| fit.effects == ["presliding"]) {
        fits.extend(built_up(problem, null));
    }
    fits.extend(heavy(problem, null));
    // what is far from nominal is for a gap that nothing near it closes
    if near_a_stop || !is_closed(problem, closest(null, &fits)) {
        fits.extend(gross(problem, null));
    }
    sort(problem, null, &mut fits);
    (fits, glimpses)
}

/// Sets of one effect more than `size`, from the best of that size.
fn widen(problem: &Problem, null: &Fit, fits: &mut Vec<Fit>, size: usize) {
    let mut seeds: Vec<&Fit> =
        fits.iter().filter(|fit| fit.set.0.len() == size).take(if size == 1 { 3 } else { 1 }).collect();
    // beside one that closes the gap, others that are far from it lead to what it leads to
    let best = closest(null, fits);
    let beside_best = is_closed(problem, best).then(|| extensions(problem, best));
    let is_told = beside_best.as_ref().is_some_and(|all| !any_promising(problem, all));
    if is_closed(problem, best) {
        let least = if is_told { 1.0 } else { CLOSE };
        let gain = |fit: &Fit| null.square - fit.square;
        seeds.retain(|seed| gain(seed) >= least * gain(best) || seed.square - best.square < FAR);
    }
    // where it tells all, others are for what may come to as much without it
    let temper = problem.formulation(best, null);
    let leads = |seed: &Fit, extension: &Extension| {
        let has = |index: &usize| extension.index == *index || seed.set.0.contains(index);
        let behind = best.evidence(temper) - seed.evidence(temper);
        !is_told || !best.set.0.iter().all(has) && extension.gain > AS_MUCH * behind
    };
    let wider: Vec<Fit> = seeds
        .par_iter()
        .flat_map(|seed| {
            let known = beside_best.as_ref().filter(|_| std::ptr::eq(*seed, best));
            let all = known.cloned().unwrap_or_else(|| extensions(problem, seed));
            best_by_effect(problem, all, EXTENSIONS)
                .into_par_iter()
                .filter(|extension| promising(problem, extension) && leads(seed, extension))
                .filter_map(|extension| extend(problem, seed, &extension))
        })
        .chain(seeds.par_iter().filter_map(|seed| saturated(problem, seed)))
        .collect();
    for fit in wider {
        if !fits.iter().any(|other| same(problem, &other.set, &fit.set)) {
            fits.push(fit);
        }
    }
    sort(problem, null, fits);
}

/// The best fit may have found a way down that the nominal parameters missed: they start there once more. And whether
/// that led further.
fn from_there(problem: &Problem, null: Fit, fits: &[Fit]) -> (Fit, bool) {
    let Some(best) = fits.first() else { return (null, false) };
    let again = refine(problem, &Set::default(), &[], Some(best), Effort::Full);
    let further = again.volume.is_finite() && again.cost() < null.cost() && again.prior < NOT_NOMINAL;
    let moved = further && null.cost() - again.cost() > 1.0;
    (if further { again } else { null }, moved)
}

/// Hypotheses that are fitted until nothing moves any more: so many, with at least this share of the best one's gain.
const POLISHED: usize = 5;
const CLOSE: f64 = 0.5;

/// Fits on from where a fit ended until it stands still.
pub(super) fn polish(problem: &Problem, fit: &mut Fit) {
    let next = refine(problem, &fit.set, &fit.values, Some(fit), Effort::Full);
    if next.volume.is_finite() {
        *fit = next;
    }
}

/// By evidence under the noise that the best of them leaves.
fn sort(problem: &Problem, null: &Fit, fits: &mut [Fit]) {
    let Some(best) = fits.iter().min_by(|a, b| a.square.total_cmp(&b.square)) else { return };
    let temper = problem.formulation(best, null);
    fits.sort_by(|a, b| b.evidence(temper).total_cmp(&a.evidence(temper)));
}

/// Whether two sets name the same effects.
pub(crate) fn same(problem: &Problem, a: &Set, b: &Set) -> bool {
    let names = |set: &Set| {
        let mut names: Vec<&str> = set.0.iter().map(|&index| problem.candidates[index].effect).collect();
        names.sort_unstable();
        names
    };
    names(a) == names(b)
}
