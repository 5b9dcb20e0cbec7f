//! Row by row through the inputs, several predictions side by side.
//!
//! All go in the same steps as long as nothing turns around, or turns around alike; where they part, each goes its own
//! way for that row.

mod step;

use std::cell::OnceCell;

use super::chain::{FULL, PHI, PHI_RATE, PLAIN, THETA, TORQUE};
use super::discrete::{DIVISIONS, Step, Steps};
use super::lanes::Lanes;
use super::law::Law;
use super::now::Now;
use super::running::Running;
use super::sprung::{ELEMENTS, Flow};
use super::{Begin, Inputs, Prediction, Push};

/// How a full step is divided: where nothing turns around, where friction turns around slowly, and where it turns
/// around at once or a stop or the motor's corner is near.
const FULL_STEP: usize = 0;
const SLOW_STEPS: usize = 1;
const SHORT_STEPS: usize = 2;
/// Change of w over a full step, over the slip rate, up to which friction turns around slowly.
const SLOWLY: f64 = 0.25;
/// Share of the friction from which on a clamp that follows over a displacement is not there yet.
const BEHIND: f64 = 1e-3;

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
    /// Length of a step of each division [s].
    steps_s: [f64; 3],
    /// What a step of each division does to springs before the friction, where there are some.
    flows: [Option<[Flow; 3]>; L],
    command: [Lanes<L>; N],
    /// Each by itself; none where there is one.
    alone: Vec<Machine<'a, N, 1>>,
}

#[allow(clippy::needless_range_loop, reason = "row by row, lane by lane")]
impl<'a, const N: usize, const L: usize> Machine<'a, N, L> {
    /// With the steps and the vehicle rates of each.
    pub(super) fn new(steps: [&'a Steps<'a, N>; L], inputs: &'a Inputs, rates: [&'a [f64]; L]) -> Self {
        let alone = |lane: usize| Machine::new([steps[lane]], inputs, [rates[lane]]);
        let (law, full_steps) = (Law::new(steps.map(|own| own.physics)), steps[0].full_steps);
        let steps_s = DIVISIONS.map(|parts| inputs.period_s / f64::from(full_steps * parts));
        Self {
            inputs,
            rates,
            flows: std::array::from_fn(|lane| law.flows(lane, steps_s)),
            law,
            free: [0, 1, 2].map(|division| Box::new(Step::beside(steps.map(|own| &own.free[division])))),
            held: OnceCell::new(),
            full_steps,
            steps_s,
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
            bulge: Lanes::all(inputs.bulge_nm[k]),
            bend: Lanes::all(0.0),
            time_s: inputs.start_s + k as f64 * inputs.period_s,
        };
        self.law.aligned(&mut now, logged, [inputs.load_by_turn[0][k], inputs.load_by_turn[1][k]]);
        self.law.between_rows(&mut now, inputs, k);
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
        let hysteresis = self.law.wound();
        let others = self.law.others(now, &x, hysteresis, |x| self.command_nm(x));
        let u = [friction + others, self.law.float_nm(now), self.law.seen(x[THETA]) - x[THETA]];
        Running {
            x,
            u,
            w,
            friction,
            zeta,
            behind: Lanes::all(0.0),
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
            wild |= state.behind[lane].abs() > BEHIND;
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
        let follows = state.behind[lane].abs() > BEHIND;
        if corner || follows || turns && (ahead - w).abs() > SLOWLY * slip {
            SHORT_STEPS
        } else if turns {
            SLOW_STEPS
        } else {
            FULL_STEP
        }
    }
}
