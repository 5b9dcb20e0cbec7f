//! One step: what is linear of it exactly, friction implicit, the stop at its end.

use super::{FULL_STEP, Machine};
use crate::simulate::chain::{PHI_RATE, PLAIN, THETA, THETA_RATE, TORQUE};
use crate::simulate::discrete::add;
use crate::simulate::lanes::Lanes;
use crate::simulate::now::Now;
use crate::simulate::running::Running;
use crate::simulate::sprung::Chain;

#[allow(clippy::needless_range_loop, reason = "row by row, lane by lane")]
impl<const N: usize, const L: usize> Machine<'_, N, L> {
    /// One step; where some are on a stop and others are not, each by itself.
    #[inline(always)]
    pub(super) fn step(&self, state: &mut Running<N, L>, to: &Now<L>, division: usize) {
        let stop = state.stop[0];
        let mut apart = false;
        for lane in 0..L {
            apart |= state.stop[lane] != stop;
        }
        if L > 1 && apart {
            for (lane, alone) in self.alone.iter().enumerate() {
                let mut one = state.of(lane);
                alone.step_by(&mut one, &to.of(lane), division);
                state.put(lane, &one);
            }
        } else {
            self.step_by(state, to, division);
        }
    }

    #[inline(always)]
    fn step_by(&self, state: &mut Running<N, L>, to: &Now<L>, division: usize) {
        let step = if state.stop[0] == 0 { &self.free[division] } else { &self.held()[division] };
        let law = &self.law;
        let mut x = step.free(&state.x, &state.u);
        let mut guess = x;
        add(&mut guess, &step.end[0], state.u[0]);
        let ahead = to.rate - guess[PHI_RATE];
        let mut hysteresis = state.hysteresis;
        if law.has_hysteresis {
            let turned_rad = 0.5 * self.steps_s[division] * (state.w + ahead);
            hysteresis = law.hysteresis_after(hysteresis, turned_rad, &mut state.stops);
        }
        let others = law.others(to, &guess, hysteresis, |x| self.command_nm(x));
        let float_nm = law.float_nm(to);
        add(&mut x, &step.end[0], others);
        if float_nm.any(float_nm, |own, _| own != 0.0) {
            add(&mut x, &step.end[1], float_nm);
        }
        let mut seen = Lanes::all(0.0);
        if law.quantised {
            seen = law.seen(guess[THETA]) - guess[THETA];
            add(&mut x, &step.end[2], seen);
        }
        let brake = step.end[0][PHI_RATE];
        let rate = to.rate - x[PHI_RATE];
        let level = law.level(to, ahead);
        let mut of_clamp = Lanes::all(1.0);
        let mut behind = Lanes::all(0.0);
        // in a full step there is nothing left to follow
        let mut clamped = [state.zeta; 2];
        let [w, zeta, share] = if law.presliding {
            self.build_up(state, [rate, brake, level], division)
        } else if law.follows && division != FULL_STEP {
            let own = law.following([state.zeta, state.w], [rate, brake, level], self.steps_s[division]);
            of_clamp = own.own;
            clamped = own.clamped;
            behind = own.clamped[1] - own.zeta;
            [own.w, own.zeta, own.share]
        } else {
            let (w, share) = law.clamp(rate, brake, level);
            clamped[1] = share;
            [w, share, share]
        };
        let friction = law.built_up(level, w) * share;
        add(&mut x, &step.end[0], friction);
        if !law.presliding && law.crosses(state.w, w) {
            // what a corner's mean is the mean of: the clamp by itself
            let by_itself = |own: Lanes<L>, w: Lanes<L>, more: Lanes<L>| {
                if law.follows { own + law.built_up(level, w) * more } else { own }
            };
            let from = by_itself(state.friction, state.w, clamped[0] - state.zeta);
            let to = by_itself(friction, w, clamped[1] - share);
            let mut off = [Lanes::all(0.0); 2];
            for lane in 0..L {
                let (before, after) = ([state.w[lane], from[lane]], [w[lane], to[lane]]);
                if let Some(mean) = law.mean_nm(lane, level[lane], before, after) {
                    off[0][lane] = of_clamp[lane] * (mean - from[lane]);
                    off[1][lane] = of_clamp[lane] * (mean - to[lane]);
                }
            }
            add(&mut x, &step.start[0], off[0]);
            add(&mut x, &step.end[0], off[1]);
        }
        let bulge = law.bulge_nm(to, zeta);
        add(&mut x, &step.start[0], bulge);
        add(&mut x, &step.end[0], bulge);
        state.x = x;
        state.u = [others + friction, float_nm, seen];
        state.w = to.rate - x[PHI_RATE];
        state.friction = friction;
        state.zeta = zeta;
        state.behind = behind;
        state.hysteresis = hysteresis;
    }

    /// Friction that builds up: w that it leaves, share built up, share of all friction.
    fn build_up(
        &self,
        state: &mut Running<N, L>,
        [rate, brake, level]: [Lanes<L>; 3],
        division: usize,
    ) -> [Lanes<L>; 3] {
        let mut built = [Lanes::all(0.0); 3];
        for lane in 0..L {
            let onto = [rate[lane], brake[lane], level[lane], self.steps_s[division]];
            let of_lane = if let Some(flows) = &self.flows[lane] {
                let chain = Chain::new(&flows[division], state.sprung.map(|force| force[lane]), state.w[lane]);
                let (w, share, forces) = chain.solve(onto[0], onto[1] * onto[2]);
                let of_lane = [w, share, share];
                state.sprung.iter_mut().zip(forces).for_each(|(sprung, force)| sprung[lane] = force);
                of_lane
            } else {
                self.law.build_up(lane, [state.w[lane], state.zeta[lane]], onto)
            };
            built.iter_mut().zip(of_lane).for_each(|(built, value)| built[lane] = value);
        }
        built
    }

    #[inline(always)]
    pub(super) fn command_nm(&self, x: &[Lanes<L>; N]) -> Lanes<L> {
        if N == PLAIN {
            return x[TORQUE];
        }
        let mut command = Lanes::all(0.0);
        for state in 0..N {
            command += self.command[state] * x[state];
        }
        command
    }

    /// The float meets a stop, or leaves it.
    #[inline(always)]
    pub(super) fn contact(&self, state: &mut Running<N, L>) {
        let mut any = false;
        for lane in 0..L {
            any |= state.stop[lane] != 0 || state.x[THETA][lane].abs() >= self.law.stop_rad[lane];
        }
        if any {
            (0..L).for_each(|lane| self.contact_of(state, lane));
        }
    }

    #[cold]
    fn contact_of(&self, state: &mut Running<N, L>, lane: usize) {
        let physics = self.law.physics[lane];
        let (gyro, stop_rad) = (&physics.config.gyro, physics.stop_rad());
        let (theta, rate) = (state.x[THETA][lane], state.x[THETA_RATE][lane]);
        let stop = f64::from(state.stop[lane]);
        if state.stop[lane] == 0 {
            if theta.abs() >= stop_rad && theta * rate > 0.0 {
                state.stop[lane] = if theta > 0.0 { 1 } else { -1 };
                state.x[THETA][lane] = stop_rad * f64::from(state.stop[lane]);
                state.x[THETA_RATE][lane] = 0.0;
                state.x[TORQUE][lane] -= self.steps[lane].jump * rate;
            }
        } else if (gyro.angular_momentum_nm_s * state.x[PHI_RATE][lane] + state.u[1][lane]) * stop < 0.0 {
            state.stop[lane] = 0;
        }
    }
}
