//! Verdicts that the signals speak against: slow noise may be estimated as high as a gap.

use super::decide::{Decision, Verdict};
use super::samples::READ_OFF;
use super::shrink::{Shrink, ShrinkSignal};

/// A residual this many times the white noise of every sensor is no noise, however slow.
const NO_NOISE: f64 = 25.0;
/// The same of every sensor where the effects named take nothing away, and of one where they are said to be all and take less
/// than so much of the gap from each [percent].
const NOTHING_GONE: f64 = 10.0;
const MOST_GONE: f64 = 70.0;
/// How likely it is then that none of the library's effects is it.
const UNKNOWN: f64 = 0.9;

/// Takes back such a verdict, and tells whether it did.
pub(crate) fn contradicted(decision: &mut Decision, shrink: &Shrink) -> bool {
    // what the samples show by themselves is in the prediction from the first
    let fitted = decision.found.iter().any(|own| !READ_OFF.contains(&own.effect));
    let Some(told) = speaks_against(decision.verdict, fitted, &shrink.signals) else { return false };
    decision.notes.push(told);
    decision.verdict = Verdict::Unexplained;
    decision.found.clear();
    decision.chosen = None;
    let unknown = decision.unknown_probability.max(UNKNOWN);
    let rest = (1.0 - unknown) / (1.0 - decision.unknown_probability).max(1e-9);
    decision.ranking.iter_mut().for_each(|set| set.probability *= rest);
    decision.unknown_probability = unknown;
    decision.alternatives = decision.others();
    true
}

/// What in the signals speaks against a verdict, whose effects were fitted or read off the samples.
fn speaks_against(verdict: Verdict, fitted: bool, signals: &[ShrinkSignal]) -> Option<String> {
    if signals.is_empty() {
        return None;
    }
    let over_noise = signals.iter().map(|signal| signal.fitted / signal.noise_floor);
    let (least, most) = over_noise.fold((f64::MAX, 0.0_f64), |(least, most), over| (least.min(over), most.max(over)));
    let gone = |end: usize| signals.iter().map(|signal| signal.ci95_percent[end]).fold(f64::MIN, f64::max);
    let nothing_goes = match verdict {
        Verdict::NoGap => least > NO_NOISE,
        _ => fitted && gone(0) <= 0.0 && least > NOTHING_GONE,
    };
    let says_all = matches!(verdict, Verdict::Explained | Verdict::CannotTell);
    let left = if nothing_goes {
        format!("what is left is at least {least:.0} times the white noise of every sensor")
    } else if says_all && fitted && gone(1) < MOST_GONE && most > NOTHING_GONE {
        format!("most of the gap is left, up to {most:.0} times the white noise of a sensor")
    } else {
        return None;
    };
    Some(format!("{left}, and nothing of the library takes it away"))
}

#[cfg(test)]
mod tests {
    use super::{ShrinkSignal, Verdict, speaks_against};

    fn signal(over_noise: f64, ci95_percent: [f64; 2]) -> ShrinkSignal {
        ShrinkSignal {
            name: "gyro_angle_rad",
            unit: "rad",
            before: 2.0 * over_noise,
            after: over_noise,
            noise_floor: 1.0,
            reduction_percent: ci95_percent[0],
            fitted: over_noise,
            ci95_percent,
        }
    }

    #[test]
    fn what_says_that_it_is_all_leaves_no_most_of_a_gap() {
        let told = |verdict, signals: &[ShrinkSignal]| speaks_against(verdict, true, signals);
        let most_stays = [signal(29.0, [19.0, 48.0]), signal(3.0, [25.0, 58.0])];
        let told_of_it = told(Verdict::Explained, &most_stays).expect("a contradiction");
        assert!(told_of_it.starts_with("most of the gap is left, up to 29 times"), "{told_of_it}");
        assert!(told(Verdict::PartlyExplained, &most_stays).is_none());
        assert!(speaks_against(Verdict::Explained, false, &most_stays).is_none());
        // noise as slow as any, and one signal that is explained
        assert!(told(Verdict::Explained, &[signal(6.0, [19.0, 48.0])]).is_none());
        assert!(told(Verdict::Explained, &[most_stays[0].clone(), signal(1.0, [90.0, 100.0])]).is_none());
    }

    #[test]
    fn what_is_far_beyond_all_noise_is_a_gap() {
        let far = [signal(26.0, [0.0, 0.0]), signal(30.0, [0.0, 0.0])];
        assert!(speaks_against(Verdict::NoGap, false, &far).is_some());
        assert!(speaks_against(Verdict::NoGap, false, &[far[0].clone(), signal(20.0, [0.0, 0.0])]).is_none());
        assert!(speaks_against(Verdict::PartlyExplained, true, &far).is_some());
    }
}
