//! What changes while a machine runs.

use super::Push;
use super::cable::Stops;
use super::chain::{INPUTS, PHI_RATE};
use super::lanes::Lanes;
use super::sprung::ELEMENTS;

/// The state of all predictions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Running<const N: usize, const L: usize> {
    pub(super) x: [Lanes<L>; N],
    /// Inputs of the chain at x.
    pub(super) u: [Lanes<L>; INPUTS],
    /// w at x.
    pub(super) w: Lanes<L>,
    pub(super) friction: Lanes<L>,
    /// Share of friction built up, with `presliding`.
    pub(super) zeta: Lanes<L>,
    /// What a clamp that follows over a displacement still has to follow.
    pub(super) behind: Lanes<L>,
    /// Forces of the springs before the friction, where there are any.
    pub(super) sprung: [Lanes<L>; ELEMENTS],
    /// Share of the full torque of the cable's loop, and the stops that it is made of, where there are any.
    pub(super) hysteresis: Lanes<L>,
    pub(super) stops: Stops<L>,
    /// -1, 0, 1.
    pub(super) stop: [i8; L],
}

impl<const N: usize, const L: usize> Running<N, L> {
    /// What is pushed at a row, under this rate of the vehicle.
    pub(super) fn push(&mut self, pushed: &mut [Option<Push>; L], row: usize, rate: Lanes<L>) {
        for (lane, pushed) in pushed.iter_mut().enumerate() {
            let Some(push) = pushed.as_mut().filter(|push| push.rows.first() == Some(&row)) else { continue };
            push.rows = &push.rows[1..];
            self.x.iter_mut().zip(push.by).for_each(|(x, by)| x[lane] += by);
            self.w[lane] = rate[lane] - self.x[PHI_RATE][lane];
        }
    }

    /// One of them.
    pub(super) fn of(&self, lane: usize) -> Running<N, 1> {
        Running {
            x: self.x.map(|x| Lanes::all(x[lane])),
            u: self.u.map(|u| Lanes::all(u[lane])),
            w: Lanes::all(self.w[lane]),
            friction: Lanes::all(self.friction[lane]),
            zeta: Lanes::all(self.zeta[lane]),
            behind: Lanes::all(self.behind[lane]),
            sprung: self.sprung.map(|sprung| Lanes::all(sprung[lane])),
            hysteresis: Lanes::all(self.hysteresis[lane]),
            stops: self.stops.of(lane),
            stop: [self.stop[lane]],
        }
    }

    /// One of them, gone on by itself.
    pub(super) fn put(&mut self, lane: usize, one: &Running<N, 1>) {
        self.x.iter_mut().zip(&one.x).for_each(|(all, one)| all[lane] = one[0]);
        self.u.iter_mut().zip(&one.u).for_each(|(all, one)| all[lane] = one[0]);
        self.w[lane] = one.w[0];
        self.friction[lane] = one.friction[0];
        self.zeta[lane] = one.zeta[0];
        self.behind[lane] = one.behind[0];
        self.sprung.iter_mut().zip(&one.sprung).for_each(|(all, one)| all[lane] = one[0]);
        self.hysteresis[lane] = one.hysteresis[0];
        self.stops.put(lane, &one.stops);
        self.stop[lane] = one.stop[0];
    }
}
