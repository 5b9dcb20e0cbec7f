//! Row by row through the inputs, several predictions side by side.
//!
//! All go in the same steps as long as nothing turns around, or turns around alike; where they part, each goes its own
//! way for that row.

use std::cell::OnceCell;

use super::chain::{FULL, PHI, PHI_RATE, PLAIN, THETA, THETA_RATE, TORQUE};
use super::discrete::{DIVISIONS, Step, Steps, add};
use super::lanes::Lanes;
use super::law::Law;
use super::now::Now;
use super::running::Running;
use super::sprung::ELEMENTS;
use super::{Begin, Inputs, Prediction, Push};

/// How a full step is divided: where nothing turns around, where friction turns around slowly, and where it turns
/// around at once or a stop or the motor's corner is near.
const FULL_STEP: usize = 0;
const SLOW_STEPS: usize = 1;
const SHORT_STEPS: usize = 2;
/// Change of w over a full step, over the slip rate, up to which friction turns around slowly.
const SLOWLY: f64 = 0.25;

/// What goes through the inputs.
pub(super) struct Machine<'a, const N: usize, const L: usize> {
    inputs: &'a Inputs,
    rates: [&'a [f64]; L],
    steps: [&'a Steps<'a, N>; L],
    law: Law<'a, L>,
    /// By division, off and on a stop.
    free: [Box<Step<N, L>>; 3],
    held: OnceCell<[Box<Step<N, L>>; 3]>,
    full_steps: u32,
    command: [Lanes<L>; N],
    /// Each by itself; none where there is one.
    alone: Vec<Machine<'a, N, 1>>,
}

#[allow(clippy::needless_range_loop, reason = "row by row, lane by lane")]
impl<'a, const N: usize, const L: usize> Machine<'a, N, L> {
    /// With the steps and the vehicle rates of each.
    pub(super) fn new(steps: [&'a Steps<'a, N>; L], inputs: &'a Inputs, rates: [&'a [f64]; L]) -> Self {
        let alone = |lane: usize| Machine::new([steps[lane]], inputs, [rates[lane]]);
        Self {
            inputs,
            rates,
            law: Law::new(steps.map(|own| own.physics)),
            free: [0, 1, 2].map(|division| Box::new(Step::beside(steps.map(|own| &own.free[division])))),
            held: OnceCell::new(),
            full_steps: steps[0].full_steps,
            command: std::array::from_fn(|state| Lanes::each(|lane| steps[lane].command[state])),
            alone: if L > 1 { (0..L).map(alone).collect() } else { Vec::new() },
            steps,
        }
    }

    #[cold]
    fn held(&self) -> &[Box<Step<N, L>>; 3] {
        self.held.get_or_init(|| {
            [0, 1, 2].map(|division| Box::new(Step::beside(self.steps.map(|own| &own.held()[division]))))
        })
    }

    #[inline(always)]
    fn now(&self, k: usize) -> Now<L> {
        let inputs = self.inputs;
        let logged = [inputs.accel_mps2[0][k], inputs.accel_mps2[1][k], inputs.accel_mps2[2][k]];
        let mut rate = Lanes::all(0.0);
        for lane in 0..L {
            rate[lane] = self.rates[lane][k];
        }
        let mut now = Now {
            accel: [Lanes::all(logged[0]), Lanes::all(logged[1]), Lanes::all(logged[2])],
            rate,
            load: Lanes::all(inputs.load_nm[k]),
            cross: inputs.cross_radps.get(k).copied().unwrap_or(0.0),
            turned: inputs.turned_rad[k],
            bulge: inputs.bulge_nm[k],
            bend: Lanes::all(0.0),
            time_s: inputs.start_s + k as f64 * inputs.period_s,
        };
        self.law.aligned(&mut now, logged, [inputs.load_by_turn[0][k], inputs.load_by_turn[1][k]]);
        self.law.between_rows(&mut now, &inputs.curve, k);
        now
    }

    /// So many rows of all.
    #[inline(always)]
    pub(super) fn run(&self, begin: [&Begin; L], mut pushed: [Option<Push>; L], rows: usize) -> [Prediction; L] {
        let rows = rows.min(self.inputs.len());
        let mut out: [Prediction; L] = std::array::from_fn(|_| Prediction::zero(rows));
        let mut now = self.now(0);
        let mut state = self.begin(begin, &now);
        for k in 0..rows {
            if k > 0 {
                let next = self.now(k);
                self.row(&mut state, &now, &next);
                now = next;
                state.push(&mut pushed, k, now.rate);
            }
            let theta = self.law.seen(state.x[THETA]);
            let torque = self.law.motor(self.command_nm(&state.x));
            for lane in 0..L {
                let out = &mut out[lane];
                out.gyro_angle_rad[k] = theta[lane];
                out.motor_torque_nm[k] = torque[lane];
                out.gimbal_angle_rad[k] = state.x[PHI][lane];
                out.gimbal_rate_radps[k] = state.x[PHI_RATE][lane];
                out.friction_nm[k] = state.friction[lane];
                out.on_stop[k] = state.stop[lane] != 0;
            }
        }
        out
    }

    fn begin(&self, begin: [&Begin; L], now: &Now<L>) -> Running<N, L> {
        let mut x = [Lanes::all(0.0); N];
        for state in 0..PLAIN {
            x[state] = Lanes::each(|lane| begin[lane].state[state]);
        }
        if N == FULL {
            x[PLAIN] = x[TORQUE];
        }
        let w = now.rate - x[PHI_RATE];
        let zeta = self.law.share(w);
        let friction = self.law.level(now, w) * zeta;
        let hysteresis = Lanes::each(|lane| begin[lane].hysteresis);
        let others = self.law.others(now, &x, hysteresis, |x| self.command_nm(x));
        let u = [friction + others, self.law.float_nm(now), self.law.seen(x[THETA]) - x[THETA]];
        Running {
            x,
            u,
            w,
            friction,
            zeta,
            sprung: [zeta; ELEMENTS],
            hysteresis,
            stops: self.law.stops(hysteresis),
            stop: [0; L],
        }
    }

    /// One row: full steps where nothing turns around, shorter ones elsewhere.
    #[inline(always)]
    fn row(&self, state: &mut Running<N, L>, now: &Now<L>, next: &Now<L>) {
        let end = |part: u32| now.end(next, part, self.full_steps);
        let mut from = if self.full_steps == 1 { *now } else { end(0) };
        for part in 1..=self.full_steps {
            let to = if self.full_steps == 1 { *next } else { end(part) };
            match if self.is_calm(state, &to) { Some(FULL_STEP) } else { self.common_division(state, &to) } {
                Some(division) => self.divided(state, &from, &to, division),
                None => {
                    for (lane, alone) in self.alone.iter().enumerate() {
                        let (mut one, to) = (state.of(lane), to.of(lane));
                        let division = alone.division(&one, &to, 0);
                        alone.divided(&mut one, &from.of(lane), &to, division);
                        state.put(lane, &one);
                    }
                }
            }
            from = to;
        }
    }

    /// A full step in its parts.
    #[inline(always)]
    fn divided(&self, state: &mut Running<N, L>, from: &Now<L>, to: &Now<L>, division: usize) {
        let parts = DIVISIONS[division];
        for part in 1..=parts {
            let end = if parts == 1 { *to } else { from.along(to, f64::from(part) / f64::from(parts)) };
            self.step(state, &end, division);
            self.contact(state);
        }
    }

    /// The division that all ask for, where they agree and are on the same stop.
    fn common_division(&self, state: &Running<N, L>, to: &Now<L>) -> Option<usize> {
        let first = self.division(state, to, 0);
        let alike = |lane: usize| self.division(state, to, lane) == first && state.stop[lane] == state.stop[0];
        (1..L).all(alike).then_some(first)
    }

    /// Whether all go in a full step.
    #[inline(always)]
    fn is_calm(&self, state: &Running<N, L>, to: &Now<L>) -> bool {
        let law = &self.law;
        let ahead = to.rate - state.x[PHI_RATE];
        let mut wild = law.presliding | law.bends;
        for lane in 0..L {
            let near = 3.0 * law.slip_radps[lane];
            wild |= state.w[lane].abs() < near;
            wild |= ahead[lane].abs() < near;
            wild |= ahead[lane] * state.w[lane] < 0.0;
            wild |= state.x[THETA][lane].abs() > 0.95 * law.stop_rad[lane];
            wild |= state.stop[lane] != 0;
        }
        !wild
    }

    /// How finely to go to `to`.
    fn division(&self, state: &Running<N, L>, to: &Now<L>, lane: usize) -> usize {
        let slip = self.law.slip_radps[lane];
        let near = 3.0 * slip;
        let w = state.w[lane];
        let ahead = to.rate[lane] - state.x[PHI_RATE][lane];
        let builds_up = self.law.presliding && (state.zeta[lane] - w.signum()).abs() > 1e-3;
        let corner = builds_up
            || state.stop[lane] != 0
            || state.x[THETA][lane].abs() > 0.95 * self.law.stop_rad[lane]
            || self.law.motor_bends(lane, self.command_nm(&state.x)[lane]);
        let turns = w.abs() < near || ahead.abs() < near || ahead * w < 0.0;
        if corner || turns && (ahead - w).abs() > SLOWLY * slip {
            SHORT_STEPS
        } else if turns {
            SLOW_STEPS
        } else {
            FULL_STEP
        }
    }

    /// One step; where some are on a stop and others are not, each by itself.
    #[inline(always)]
    fn step(&self, state: &mut Running<N, L>, to: &Now<L>, division: usize) {
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
            let turned_rad = 0.5 * self.step_s(division) * (state.w + ahead);
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
        let [w, zeta, share] = if law.presliding {
            self.build_up(state, [rate, brake, level], self.step_s(division))
        } else if law.follows && division != FULL_STEP {
            let [w, zeta, share, own] =
                law.following([state.zeta, state.w], [rate, brake, level], self.step_s(division));
            of_clamp = own;
            [w, zeta, share]
        } else {
            let (w, share) = law.clamp(rate, brake, level);
            [w, share, share]
        };
        let friction = law.built_up(level, w) * share;
        add(&mut x, &step.end[0], friction);
        if !law.presliding && law.crosses(state.w, w) {
            // what a corner's mean is the mean of: the clamp by itself
            let clamped = |own: Lanes<L>, w: Lanes<L>, share: Lanes<L>| {
                if law.follows { own + law.built_up(level, w) * (law.share(w) - share) } else { own }
            };
            let (from, to) = (clamped(state.friction, state.w, state.zeta), clamped(friction, w, share));
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
        state.hysteresis = hysteresis;
    }

    /// Friction that builds up: w that it leaves, share built up, share of all friction.
    fn build_up(&self, state: &mut Running<N, L>, [rate, brake, level]: [Lanes<L>; 3], step_s: f64) -> [Lanes<L>; 3] {
        let mut built = [Lanes::all(0.0); 3];
        for lane in 0..L {
            let onto = [rate[lane], brake[lane], level[lane], step_s];
            let of_lane = if self.law.is_sprung(lane) {
                let from = state.sprung.map(|force| force[lane]);
                let (of_lane, forces) = self.law.sprung(lane, state.w[lane], from, onto);
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
    fn step_s(&self, division: usize) -> f64 {
        self.inputs.period_s / f64::from(self.full_steps * DIVISIONS[division])
    }

    #[inline(always)]
    fn command_nm(&self, x: &[Lanes<L>; N]) -> Lanes<L> {
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
    fn contact(&self, state: &mut Running<N, L>) {
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
