//! States that remember where the axis came from.

use std::iter::successors;

/// Dahl's state over its limit: dz = (1 - z sgn(dq))/displacement dq, exact between rows.
pub(super) fn dahl_state(q: &[f64], displacement: f64) -> Vec<f64> {
    let mut z = 0.0_f64;
    let mut last = q[0];
    q.iter()
        .map(|&now| {
            let step = now - last;
            last = now;
            let towards = step.signum();
            if step != 0.0 {
                z = towards - (towards - z) * (-step.abs() / displacement).exp();
            }
            z
        })
        .collect()
}

/// How what slips yields: at one displacement, or as elements in parallel that yield one after the other (Iwan's).
///
/// ```text
/// z = sum s_i z_i        dz_i = dq / d_i, |z_i| <= 1        sum s_i = 1, sum s_i / d_i = 1 / d
/// even: alike in stiffness, d_i from nothing to 2 d evenly        wide: alike in strength, d_i as powers of 1.7
/// ```
///
/// Source: W. D. Iwan, *A distributed-element model for hysteresis and its steady-state dynamic response*, J. Appl. Mech. 33 (4), 1966.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Yields {
    One,
    Even,
    Wide,
}

/// Elements in parallel.
const ELEMENTS: usize = 6;
/// Yield of an element over that of the one before, where they are wide apart.
const APART: f64 = 1.7;

impl Yields {
    pub(super) const ALL: [Self; 3] = [Self::One, Self::Even, Self::Wide];

    /// What a report says of it.
    pub(super) fn numbers(self) -> Vec<(&'static str, f64)> {
        match self {
            Self::One => Vec::new(),
            Self::Even => vec![("elements", ELEMENTS as f64)],
            Self::Wide => vec![("elements", ELEMENTS as f64), ("yields_apart", APART)],
        }
    }

    /// Each element's displacement over that of all, and its share of the strength.
    fn elements(self) -> Vec<(f64, f64)> {
        let n = ELEMENTS as f64;
        match self {
            Self::One => vec![(1.0, 1.0)],
            Self::Even => (0..ELEMENTS).map(|i| (2.0 * i as f64 + 1.0) / n).map(|own| (own, own / n)).collect(),
            Self::Wide => {
                let powers: Vec<f64> = successors(Some(1.0), |own| Some(APART * own)).take(ELEMENTS).collect();
                let soft = powers.iter().map(|own| 1.0 / own).sum::<f64>() / n;
                powers.iter().map(|own| (own * soft, 1.0 / n)).collect()
            }
        }
    }

    /// State over its limit; `displacement` is the limit over the stiffness of all that stick.
    pub(super) fn state(self, q: &[f64], displacement: f64) -> Vec<f64> {
        let mut sum = vec![0.0; q.len()];
        for (ratio, share) in self.elements() {
            let own = play_state(q, 2.0 * ratio * displacement);
            sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += share * own);
        }
        sum
    }
}

/// Play over half its width: the state follows the position, clamped to +-1.
pub(super) fn play_state(q: &[f64], width: f64) -> Vec<f64> {
    let mut state = 0.0_f64;
    let mut last = q[0];
    q.iter()
        .map(|&now| {
            state = (state + 2.0 * (now - last) / width).clamp(-1.0, 1.0);
            last = now;
            state
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::Yields;

    #[test]
    fn closed_form_all_begin_with_one_stiffness_end_at_one_limit_and_turn_around_at_twice_the_size() {
        let way = |to: f64| (0..=4000).map(move |step| to * f64::from(step) / 4000.0);
        for yields in Yields::ALL {
            let last = |ways: Vec<f64>| *yields.state(&ways, 0.02).last().expect("rows");
            let up = |to: f64| last(way(to).collect());
            assert!((up(1e-3) - 0.05).abs() < 1e-9, "{yields:?} {}", up(1e-3));
            assert!((up(0.2) - 1.0).abs() < 1e-9, "{yields:?} {}", up(0.2));
            // Masing's rule
            let back = last(way(0.03).chain(way(0.024).map(|down| 0.03 - down)).collect());
            assert!((up(0.03) - back - 2.0 * up(0.012)).abs() < 1e-9, "{yields:?} {back}");
        }
        // evenly spread: a parabola's tangents
        let even = Yields::Even.state(&way(0.03).collect::<Vec<_>>(), 0.02);
        assert!((even[4000] - (1.5 - 0.25 * 1.5_f64.powi(2))).abs() < 0.25 / 36.0, "{}", even[4000]);
    }
}
