//! Friction that is reached through springs: the nominal law, and the compliance before it in series.
//!
//! ```text
//! d_i m_i' = w - w_s m_i      |m_i| <= 1      friction = level (m_1 + m_2 + m_3) / 3
//! d_i = (1/3, 1, 5/3) 23/15 d                 1/d: stiffness of all together over the level
//! ```
//!
//! What a spring does not take up slips, as fast as the nominal law says of the force that the spring carries; at the
//! full force, as fast as it must. Where the bearing turns around at once this is a chain of elasto-slip elements
//! whose yields are spread evenly from nothing to the largest, by three of them; slower than the slip rate `w_s` it
//! is the nominal law, late by `d_i / w_s`.
//!
//! Source: W. D. Iwan, *A distributed-element model for hysteresis and its steady-state dynamic response*, J. Appl.
//! Mech. 33 (4), 1966.

use super::lanes::within;

/// Elements of the chain.
pub(super) const ELEMENTS: usize = 3;
/// Displacement at which each yields, over that of the chain.
const YIELDS: [f64; ELEMENTS] = [23.0 / 45.0, 23.0 / 15.0, 23.0 / 9.0];
const SHARE: f64 = 1.0 / ELEMENTS as f64;
/// Lines between the corners of all.
const CORNERS: usize = 2 * ELEMENTS;
/// Of the rate: rounding.
const CLOSE: f64 = 1e-14;

/// Force of each spring, over the one at which it yields.
pub(super) type Forces = [f64; ELEMENTS];

/// What a step of one length does to each spring, at one slip rate.
pub(super) struct Flow {
    slip_radps: f64,
    /// Share of its force that is gone, and the mean of that over the step.
    gone: Forces,
    mean: Forces,
}

impl Flow {
    pub(super) fn new([along_rad, slip_radps]: [f64; 2], step_s: f64) -> Self {
        let flow = YIELDS.map(|yields| step_s * slip_radps / (yields * along_rad));
        let gone = flow.map(|flow| -(-flow).exp_m1());
        Self { slip_radps, gone, mean: std::array::from_fn(|place| gone[place] / flow[place]) }
    }
}

/// The chain over one step in which the rate runs along a line, exactly: its forces where the rate ends at zero, and
/// what each rad/s adds.
pub(super) struct Chain {
    at_rest: Forces,
    by_rate: Forces,
}

impl Chain {
    /// From the forces and the rate before the step.
    pub(super) fn new(flow: &Flow, forces: Forces, before_radps: f64) -> Self {
        let Flow { slip_radps, gone, mean } = flow;
        let before = before_radps / slip_radps;
        let at_rest = |own: usize| forces[own] * (1.0 - gone[own]) + before * (mean[own] + gone[own] - 1.0);
        Self { at_rest: std::array::from_fn(at_rest), by_rate: mean.map(|mean| (1.0 - mean) / slip_radps) }
    }

    /// `w + pull share(w) = rate`: w, the share of the friction that is built up, the forces. Newton's steps between
    /// the corners where springs yield; the share rises with w, so that few are needed.
    pub(super) fn solve(&self, rate: f64, pull: f64) -> (f64, f64, Forces) {
        let mut w = rate;
        let mut forces = self.forces(w);
        for _ in 0..CORNERS {
            let off = w + pull * share(&forces) - rate;
            if off.abs() <= CLOSE * rate.abs() {
                break;
            }
            let holds = forces.iter().zip(&self.by_rate).filter(|(force, _)| force.abs() < 1.0);
            let slope: f64 = holds.map(|(_, by_rate)| SHARE * by_rate).sum();
            w -= off / (1.0 + pull * slope);
            forces = self.forces(w);
        }
        (w, share(&forces), forces)
    }

    fn forces(&self, w: f64) -> Forces {
        std::array::from_fn(|place| within(self.at_rest[place] + self.by_rate[place] * w, 1.0))
    }
}

fn share(forces: &Forces) -> f64 {
    SHARE * forces.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::{Chain, Flow};

    const ALONG_RAD: f64 = 1e-5;
    const SLIP_RADPS: f64 = 2e-3;

    /// Forces after so many equal steps at one rate.
    fn share_after(rate: f64, step_s: f64, steps: u32) -> f64 {
        let mut forces = [0.0; 3];
        let mut share = 0.0;
        for _ in 0..steps {
            let chain = Chain::new(&Flow::new([ALONG_RAD, SLIP_RADPS], step_s), forces, rate);
            (_, share, forces) = chain.solve(rate, 0.0);
        }
        share
    }

    #[test]
    fn closed_form_stiff_at_first_full_at_last_and_the_nominal_law_below_the_slip_rate() {
        // quick: a hundredth of the displacement, then more than the last yield
        assert!((share_after(1.0, 1e-7, 1) - 0.01).abs() < 1e-5);
        assert!((share_after(1.0, 1e-6, 26) - 1.0).abs() < 1e-12);
        assert!(share_after(1.0, 1e-6, 25) < 1.0);
        // slow: in long steps as in short ones
        for (step_s, steps) in [(1.0, 1), (1e-3, 1000)] {
            assert!((share_after(-0.3 * SLIP_RADPS, step_s, steps) + 0.3).abs() < 1e-9);
        }
    }

    #[test]
    fn closed_form_what_is_left_of_the_rate_balances_friction() {
        let chain = Chain::new(&Flow::new([ALONG_RAD, SLIP_RADPS], 5e-4), [0.9, -0.2, -0.4], 4e-3);
        for rate in [-1.0, -0.02, -1e-4, 0.0, 3e-3, 0.05] {
            for pull in [0.0, 1e-4, 1e-2, 0.3] {
                let (w, share, _) = chain.solve(rate, pull);
                assert!((w + pull * share - rate).abs() < 1e-13, "{rate} {pull}: {w} {share}");
            }
        }
    }
}
