//! Probabilities of sets of effects, from what each is worth.

use super::set::is_part;
use super::weigh::Weighed;

/// Nats that count as one in probabilities, of a single effect and of one more: from logs with open answers, as what the
/// noise is not known for and what the formulation leaves weigh in; and the share of what the best set gains.
const SCALE: f64 = 3.5;
const SCALE_BESIDE: f64 = 5.0;
const SCALE_SHARE: f64 = 1e-5;
/// The same where evidence is as small as chance makes it, and how far below that reaches [nats].
const SCALE_OF_CHANCE: f64 = 1.0;
const CHANCE: f64 = 1.0;
/// Probability from which on fuller sets are named in the place of the one that is part of them.
const LIKELIER: f64 = 0.5;
/// How much likelier than that one the likeliest of them must be.
const THAN_ONE: f64 = 1.5;
/// How likely one must be over another to be as likely.
const AS_LIKELY: f64 = 0.9;
/// Probability of there being nothing from which on down there is something.
const HARDLY: f64 = 0.1;

/// A set of effects and its probability.
#[derive(Debug, Clone, PartialEq)]
pub struct SetProbability {
    /// Names, in alphabetical order.
    pub effects: Vec<&'static str>,
    /// Of the set.
    pub probability: f64,
}

/// Probabilities of sets that something of the library explains, or nothing has to be explained.
pub(crate) struct Probabilities {
    sets: Vec<f64>,
    nothing: f64,
}

impl Probabilities {
    /// Each set beside the likeliest part of it: a second effect is as likely as what it brings beside the first.
    pub(crate) fn new(sets: &[Weighed]) -> Self {
        let top = sets.iter().map(|set| set.nats).fold(0.0, f64::max);
        let mut order: Vec<usize> = (0..sets.len()).collect();
        order.sort_by_key(|&index| sets[index].effects.len());
        let mut logs = vec![f64::NEG_INFINITY; sets.len()];
        for &index in &order {
            let set = &sets[index];
            let part = |other: &&usize| is_part(&sets[**other].effects, &set.effects);
            let likeliest = order.iter().filter(part).max_by(|a, b| logs[**a].total_cmp(&logs[**b]));
            let (log, nats, rare) = likeliest
                .filter(|&&other| logs[other] > 0.0)
                .map_or((0.0, 0.0, 0.0), |&other| (logs[other], sets[other].nats, sets[other].rare));
            let beyond = set.nats - nats - (set.rare - rare);
            let scale = SCALE_SHARE * top + if set.effects.len() > 1 { SCALE_BESIDE } else { SCALE };
            logs[index] = log + (beyond / scale).min((beyond + CHANCE) / SCALE_OF_CHANCE);
        }
        let highest = logs.iter().copied().fold(0.0, f64::max);
        let weights: Vec<f64> = logs.iter().map(|log| (log - highest).exp()).collect();
        let nothing = (-highest).exp();
        let sum = nothing + weights.iter().sum::<f64>();
        Self { sets: weights.iter().map(|weight| weight / sum).collect(), nothing: nothing / sum }
    }

    /// The likeliest set that holds one and another effect, or more of them where it outweighs everything else by itself, if
    /// such sets together are likelier than everything else, and it alone is likelier than the one: once there is a gap, a
    /// further effect need not bring what the first one has to.
    pub(crate) fn fuller<'a>(&self, sets: &'a [Weighed], best: &'a Weighed) -> &'a Weighed {
        let fuller = || {
            let fitted = |(set, probability): &(&'a Weighed, &f64)| {
                let one_more = set.effects.len() == best.effects.len() + 1 || **probability > LIKELIER;
                set.fit.is_some() && one_more && is_part(&best.effects, &set.effects)
            };
            sets.iter().zip(&self.sets).filter(fitted)
        };
        let together: f64 = fuller().map(|(_, probability)| probability).sum();
        let own = self.of(sets, best);
        let likeliest = fuller().max_by(|a, b| a.1.total_cmp(b.1));
        let likelier = |(_, probability): &(&Weighed, &f64)| together > LIKELIER && **probability > THAN_ONE * own;
        likeliest.filter(likelier).map_or(best, |(set, _)| set)
    }

    fn of(&self, sets: &[Weighed], one: &Weighed) -> f64 {
        sets.iter().zip(&self.sets).find(|(set, _)| set.effects == one.effects).map_or(0.0, |own| *own.1)
    }

    /// The sets that were fitted, hold one and another effect, and are as likely as that one.
    pub(crate) fn no_less_likely<'a>(&self, sets: &'a [Weighed], one: &Weighed) -> Vec<&'a Weighed> {
        let own = self.of(sets, one);
        let likely = |(set, probability): &(&Weighed, &f64)| {
            set.fit.is_some() && is_part(&one.effects, &set.effects) && **probability > AS_LIKELY * own
        };
        sets.iter().zip(&self.sets).filter(likely).map(|(set, _)| set).collect()
    }

    /// The likeliest set, where there being nothing is improbable though no set brings what it has to by itself; a torque on
    /// the float has to, which a bias of the logged rate seems to be too.
    pub(crate) fn rather_than_nothing<'a>(&self, sets: &'a [Weighed]) -> Option<&'a Weighed> {
        let fitted = sets.iter().zip(&self.sets).filter(|(set, _)| set.fit.is_some());
        let likeliest = fitted.max_by(|a, b| a.1.total_cmp(b.1)).map(|(set, _)| set);
        likeliest.filter(|set| self.nothing < HARDLY && !set.acts_on_float())
    }

    /// The most probable first.
    pub(crate) fn ranking(&self, sets: &[Weighed], share: f64) -> Vec<SetProbability> {
        let of = |(set, probability): (&Weighed, &f64)| SetProbability {
            effects: set.effects.clone(),
            probability: share * probability,
        };
        let mut ranking: Vec<SetProbability> = sets.iter().zip(&self.sets).map(of).collect();
        ranking.push(SetProbability { effects: Vec::new(), probability: share * self.nothing });
        ranking.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        ranking
    }
}
