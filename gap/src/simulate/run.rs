//! Row by row through the inputs.

use pulp::Arch;

use super::bearing::Viscous;
use super::chain::{Chain, FULL, INPUTS, PHI, PHI_RATE, PLAIN, THETA, THETA_RATE, TORQUE};
use super::discrete::{Step, add};
use super::inputs::turned;
use super::{Inputs, Physics};

const GRAVITY_MPS2: f64 = 9.806_65;
/// Longest full step [s].
const LONGEST_STEP_S: f64 = 1.2e-3;
/// Into how many steps a full one is divided: where nothing turns around, where friction turns around slowly, and
/// where it turns around at once or a stop or the motor's corner is near.
const DIVISIONS: [u32; 3] = [1, 6, 16];
const FULL_STEP: usize = 0;
const SLOW_STEPS: usize = 1;
const SHORT_STEPS: usize = 2;
/// Change of w over a full step, over the slip rate, up to which friction turns around slowly.
const SLOWLY: f64 = 0.25;

/// Where a prediction begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Begin {
    /// phi', theta, theta', four sections, integrator, motor torque, phi.
    pub state: [f64; PLAIN],
    /// Share of the cable's loop.
    pub hysteresis: f64,
}

/// What the sensors would read, and what they do not see.
#[derive(Debug, Clone, Default)]
pub struct Prediction {
    /// Pick-off angle as logged [rad].
    pub gyro_angle_rad: Vec<f64>,
    /// Motor torque as logged [N m].
    pub motor_torque_nm: Vec<f64>,
    /// phi [rad].
    pub gimbal_angle_rad: Vec<f64>,
    /// phi' [rad/s].
    pub gimbal_rate_radps: Vec<f64>,
    /// Bearing friction [N m].
    pub friction_nm: Vec<f64>,
    /// Rows on a stop.
    pub on_stop: Vec<bool>,
}

impl Begin {
    /// At rest under the first row, with the pick-off angle and motor torque that the log begins with.
    #[must_use]
    pub fn at(physics: &Physics, inputs: &Inputs, theta_rad: f64, torque_nm: Option<f64>) -> Self {
        let mut state = [0.0; PLAIN];
        let rate = inputs.rate_radps[0];
        let level = inputs.load_nm[0] + Viscous::new(&physics.config.bearing).torque_nm(rate.abs());
        let unbalance = &physics.config.unbalance;
        let disturbance = level * (rate / physics.config.bearing.slip_rate_radps).clamp(-1.0, 1.0)
            + unbalance.torque_nm(inputs.accel_mps2[0][0], inputs.accel_mps2[1][0]);
        state[THETA] = theta_rad;
        state[super::chain::INTEGRATOR] = torque_nm.unwrap_or(disturbance);
        state[TORQUE] = torque_nm.unwrap_or(disturbance);
        Self { state, hysteresis: 0.0 }
    }
}

/// Runs the physics over the inputs.
#[must_use]
pub fn predict(physics: &Physics, inputs: &Inputs, begin: &Begin, rows: usize) -> Prediction {
    let shifted;
    let inputs = if physics.measurement.skew_s == 0.0 {
        inputs
    } else {
        shifted = inputs.advanced(physics.measurement.skew_s);
        &shifted
    };
    // the widest vectors that there are; bits are the same with all
    let mut prediction = if Chain::states(physics) == PLAIN {
        let machine = Machine::<PLAIN>::new(physics, inputs);
        Arch::new().dispatch(|| machine.run(begin, rows))
    } else {
        let machine = Machine::<FULL>::new(physics, inputs);
        Arch::new().dispatch(|| machine.run(begin, rows))
    };
    let sensors = physics.measurement;
    for theta in &mut prediction.gyro_angle_rad {
        *theta = *theta * sensors.pickoff_factor + sensors.pickoff_bias_rad;
    }
    for torque in &mut prediction.motor_torque_nm {
        *torque = *torque * sensors.torque_factor + sensors.torque_bias_nm;
    }
    prediction
}

/// The inputs at one instant.
#[derive(Debug, Clone, Copy, Default)]
struct Now {
    accel: [f64; 3],
    rate: f64,
    cross: f64,
    turned: f64,
    load: f64,
    bulge: f64,
    time_s: f64,
}

impl Now {
    #[inline(always)]
    fn toward(&self, next: &Self, share: f64) -> Self {
        let line = |a: f64, b: f64| a + share * (b - a);
        Self {
            accel: std::array::from_fn(|axis| line(self.accel[axis], next.accel[axis])),
            rate: line(self.rate, next.rate),
            cross: line(self.cross, next.cross),
            turned: line(self.turned, next.turned),
            load: line(self.load, next.load),
            bulge: next.bulge,
            time_s: line(self.time_s, next.time_s),
        }
    }
}

/// What changes while the machine runs.
#[derive(Debug, Clone, Copy)]
struct Running<const N: usize> {
    x: [f64; N],
    /// Inputs of the chain at x.
    u: [f64; INPUTS],
    /// w at x.
    w: f64,
    friction: f64,
    /// Share of friction built up, with `presliding`.
    zeta: f64,
    hysteresis: f64,
    /// -1, 0, 1.
    stop: i8,
}

struct Machine<'a, const N: usize> {
    physics: &'a Physics,
    inputs: &'a Inputs,
    viscous: Viscous,
    /// By division, off and on a stop.
    free: [Step<N>; 3],
    held: [Step<N>; 3],
    full_steps: u32,
    command: [f64; N],
}

impl<'a, const N: usize> Machine<'a, N> {
    fn new(physics: &'a Physics, inputs: &'a Inputs) -> Self {
        let period_s = inputs.period_s;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few")]
        let full_steps = (period_s / LONGEST_STEP_S).ceil().max(1.0) as u32;
        let (off, on) = (Chain::new(physics, false), Chain::new(physics, true));
        let full_s = period_s / f64::from(full_steps);
        let steps = |chain: &Chain| DIVISIONS.map(|parts| Step::new(chain, full_s / f64::from(parts)));
        let command = std::array::from_fn(|state| off.command[state]);
        let viscous = Viscous::new(&physics.config.bearing);
        Self { physics, inputs, viscous, free: steps(&off), held: steps(&on), full_steps, command }
    }

    #[inline(always)]
    fn now(&self, k: usize) -> Now {
        let inputs = self.inputs;
        let logged = [0, 1, 2].map(|axis| inputs.accel_mps2[axis][k]);
        let mut now = Now {
            accel: logged,
            rate: inputs.rate_radps[k],
            cross: inputs.cross_radps.get(k).copied().unwrap_or(0.0),
            turned: inputs.turned_rad[k],
            load: inputs.load_nm[k],
            bulge: inputs.bulge_nm[k],
            time_s: inputs.start_s + k as f64 * inputs.period_s,
        };
        let turn = self.physics.turned_rad;
        if turn.iter().any(|angle| angle.abs() > 0.0) {
            now.accel = turned(logged, turn);
            now.load += turn[0] * inputs.load_by_turn[0][k] + turn[1] * inputs.load_by_turn[1][k];
        }
        now
    }

    #[inline(always)]
    fn run(&self, begin: &Begin, rows: usize) -> Prediction {
        let rows = rows.min(self.inputs.len());
        let mut out = Prediction {
            gyro_angle_rad: Vec::with_capacity(rows),
            motor_torque_nm: Vec::with_capacity(rows),
            gimbal_angle_rad: Vec::with_capacity(rows),
            gimbal_rate_radps: Vec::with_capacity(rows),
            friction_nm: Vec::with_capacity(rows),
            on_stop: Vec::with_capacity(rows),
        };
        let mut now = self.now(0);
        let mut state = self.begin(begin, &now);
        for k in 0..rows {
            if k > 0 {
                let next = self.now(k);
                self.row(&mut state, &now, &next);
                now = next;
            }
            out.gyro_angle_rad.push(self.seen(state.x[THETA]));
            out.motor_torque_nm.push(self.motor(self.command_nm(&state.x)));
            out.gimbal_angle_rad.push(state.x[PHI]);
            out.gimbal_rate_radps.push(state.x[PHI_RATE]);
            out.friction_nm.push(state.friction);
            out.on_stop.push(state.stop != 0);
        }
        out
    }

    #[inline(always)]
    fn begin(&self, begin: &Begin, now: &Now) -> Running<N> {
        let mut x = [0.0; N];
        x[..PLAIN].copy_from_slice(&begin.state);
        if N == FULL {
            x[10] = x[TORQUE];
        }
        let w = now.rate - x[PHI_RATE];
        let slip = self.physics.config.bearing.slip_rate_radps;
        let zeta = (w / slip).clamp(-1.0, 1.0);
        let friction = self.level(now, w) * zeta;
        let u = [friction + self.others(now, &x, begin.hysteresis), self.float_nm(now), self.seen(x[THETA]) - x[THETA]];
        Running { x, u, w, friction, zeta, hysteresis: begin.hysteresis, stop: 0 }
    }

    /// One row: full steps where nothing turns around, shorter ones elsewhere.
    #[inline(always)]
    fn row(&self, state: &mut Running<N>, now: &Now, next: &Now) {
        let mut from = *now;
        for part in 1..=self.full_steps {
            let to = if part == self.full_steps {
                *next
            } else {
                now.toward(next, f64::from(part) / f64::from(self.full_steps))
            };
            let division = self.division(state, &to);
            let parts = DIVISIONS[division];
            for part in 1..=parts {
                let end = if part == parts { to } else { from.toward(&to, f64::from(part) / f64::from(parts)) };
                self.step(state, &end, division);
                self.contact(state);
            }
            from = to;
        }
    }

    /// How finely to go to `to`.
    #[inline(always)]
    fn division(&self, state: &Running<N>, to: &Now) -> usize {
        let slip = self.physics.config.bearing.slip_rate_radps;
        let near = 3.0 * slip;
        let ahead = to.rate - state.x[PHI_RATE];
        let builds_up = self.physics.friction.presliding_rad > 0.0 && (state.zeta - state.w.signum()).abs() > 1e-3;
        let corner = builds_up
            || state.stop != 0
            || state.x[THETA].abs() > 0.95 * self.physics.config.gyro.stop_angle_rad
            || self.motor_bends(state);
        let turns = state.w.abs() < near || ahead.abs() < near || ahead * state.w < 0.0;
        if corner || turns && (ahead - state.w).abs() > SLOWLY * slip {
            SHORT_STEPS
        } else if turns {
            SLOW_STEPS
        } else {
            FULL_STEP
        }
    }

    /// Whether the motor's torque is near a corner of its characteristic.
    #[inline(always)]
    fn motor_bends(&self, state: &Running<N>) -> bool {
        let (dead_nm, limit_nm) = (self.physics.dead_zone_nm, self.physics.limit_nm.unwrap_or(f64::MAX));
        if dead_nm <= 0.0 && limit_nm >= f64::MAX {
            return false;
        }
        let command = self.command_nm(&state.x).abs();
        command < 2.0 * dead_nm || command > 0.95 * limit_nm
    }

    #[inline(always)]
    fn step(&self, state: &mut Running<N>, to: &Now, division: usize) {
        let step = if state.stop == 0 { &self.free[division] } else { &self.held[division] };
        let mut x = step.free(&state.x, &state.u);
        let mut guess = x;
        add(&mut guess, &step.end[0], state.u[0]);
        let ahead = to.rate - guess[PHI_RATE];
        let turned = 0.5 * self.step_s(division) * (state.w + ahead);
        let hysteresis = self.hysteresis_after(state.hysteresis, turned);
        let others = self.others(to, &guess, hysteresis);
        let float_nm = self.float_nm(to);
        add(&mut x, &step.end[0], others);
        if float_nm != 0.0 {
            add(&mut x, &step.end[1], float_nm);
        }
        let mut seen = 0.0;
        if self.physics.quantum_rad > 0.0 {
            seen = self.seen(guess[THETA]) - guess[THETA];
            add(&mut x, &step.end[2], seen);
        }
        let brake = step.end[0][PHI_RATE];
        let rate = to.rate - x[PHI_RATE];
        let level = self.level(to, ahead);
        let (friction, mean, zeta) = if self.physics.friction.presliding_rad > 0.0 {
            self.build_up(state, [rate, brake, level, self.step_s(division)])
        } else {
            self.clamp(state, rate, brake, level)
        };
        add(&mut x, &step.end[0], friction);
        if let Some(mean) = mean {
            add(&mut x, &step.start[0], mean - state.friction);
            add(&mut x, &step.end[0], mean - friction);
        }
        let bulge = to.bulge * self.physics.friction.load_factor * zeta;
        add(&mut x, &step.start[0], bulge);
        add(&mut x, &step.end[0], bulge);
        *state = Running {
            x,
            u: [others + friction, float_nm, seen],
            w: to.rate - x[PHI_RATE],
            friction,
            zeta,
            hysteresis,
            stop: state.stop,
        };
    }

    #[inline(always)]
    fn step_s(&self, division: usize) -> f64 {
        self.inputs.period_s / f64::from(self.full_steps * DIVISIONS[division])
    }

    /// The clamp, implicit: `w + brake level clamp(w / w_s) = rate`; and its mean where the step crosses a corner.
    #[inline(always)]
    fn clamp(&self, state: &Running<N>, rate: f64, brake: f64, level: f64) -> (f64, Option<f64>, f64) {
        let slip = self.physics.config.bearing.slip_rate_radps;
        let asymmetry = self.physics.friction.asymmetry;
        let side = |w: f64| level * (1.0 + asymmetry * sign(w));
        let pull = brake * side(rate);
        let w = if rate.abs() > slip + pull { rate - pull * rate.signum() } else { rate / (1.0 + pull / slip) };
        let zeta = (w / slip).clamp(-1.0, 1.0);
        let friction = side(w) * zeta;
        let (low, high) = (state.w.min(w), state.w.max(w));
        let crosses = (low < -slip && high > -slip) || (low < slip && high > slip);
        let mean = (crosses && high - low > 1e-9).then(|| {
            let area = |w: f64| {
                let a = w.abs();
                side(w) * if a > slip { a - 0.5 * slip } else { 0.5 * a * a / slip }
            };
            (area(high) - area(low)) / (high - low)
        });
        let mean = mean.or_else(|| {
            // the two viscous laws do not meet
            let edge = self.viscous.break_radps();
            let crosses = (low < edge && high > edge) || (low < -edge && high > -edge);
            let share = (edge - state.w.abs()) / (w.abs() - state.w.abs());
            crosses.then_some(state.friction + (1.0 - share) * (friction - state.friction))
        });
        (friction, mean, zeta)
    }

    /// Dahl's build-up over the displacement of the step.
    #[inline(always)]
    fn build_up(&self, state: &Running<N>, [rate, brake, level, step_s]: [f64; 4]) -> (f64, Option<f64>, f64) {
        let along = self.physics.friction.presliding_rad;
        let asymmetry = self.physics.friction.asymmetry;
        let mut zeta = state.zeta;
        for _ in 0..3 {
            let w = rate - brake * level * zeta;
            let leg = |zeta: f64, w: f64, moved: f64| {
                let side = sign(w);
                side + (zeta - side) * (-moved.abs() / along).exp()
            };
            zeta = if w * state.w < 0.0 {
                let share = state.w / (state.w - w);
                let turned = leg(state.zeta, state.w, 0.5 * state.w * share * step_s);
                leg(turned, w, 0.5 * w * (1.0 - share) * step_s)
            } else {
                leg(state.zeta, state.w + w, 0.5 * (state.w + w) * step_s)
            };
        }
        let w = rate - brake * level * zeta;
        (level * (1.0 + asymmetry * sign(w)) * zeta, None, zeta)
    }

    /// `T_load + T_visc` and what effects make of it.
    #[inline(always)]
    fn level(&self, now: &Now, w: f64) -> f64 {
        if self.physics.config.bearing.count == 0 {
            return 0.0;
        }
        let friction = &self.physics.friction;
        let mut load = now.load * friction.load_factor;
        if friction.per_g != 0.0 {
            load *= 1.0 + friction.per_g * now.accel[0].hypot(now.accel[1]) / GRAVITY_MPS2;
        }
        let mut level = load + self.viscous.torque_nm(w.abs()) * friction.viscous_factor;
        if let Some([excess, rate]) = friction.stribeck {
            level += excess * (-(w / rate) * (w / rate)).exp();
        }
        if let Some([ratio, time_s]) = friction.drift {
            level *= 1.0 - ratio * (-now.time_s / time_s).exp_m1();
        }
        level
    }

    /// Torques on the gimbal but for the bearings', and what the motor fails to give.
    #[inline(always)]
    fn others(&self, now: &Now, x: &[f64; N], hysteresis: f64) -> f64 {
        let physics = self.physics;
        let [ax, ay, _] = now.accel;
        let unbalance = &physics.config.unbalance;
        let w = now.rate - x[PHI_RATE];
        let rel = now.turned - x[PHI];
        let mut torque = unbalance.x_kg_m * ay - unbalance.y_kg_m * ax
            + physics.constant_nm
            + physics.anisoelasticity * ax * ay
            + physics.cross_axis_kg_m2 * now.rate * now.cross
            + physics.spring_nm_per_rad * rel
            + (physics.friction.viscous_nm_s + physics.friction.quadratic_nm_s2 * w.abs()) * w;
        if let Some(cable) = physics.hysteresis {
            torque += cable.torque_nm * hysteresis;
        }
        if let Some(ripple) = physics.ripple {
            let (sine, cosine) = (ripple.cycles * rel).sin_cos();
            torque += ripple.sine_nm * sine + ripple.cosine_nm * cosine;
        }
        if physics.limit_nm.is_some() || physics.dead_zone_nm > 0.0 {
            let command = self.command_nm(x);
            torque += command - self.motor(command);
        }
        torque
    }

    #[inline(always)]
    fn hysteresis_after(&self, z: f64, turned: f64) -> f64 {
        let Some(cable) = self.physics.hysteresis else { return z };
        let slope = |z: f64| if z * turned > 0.0 { 1.0 - z * z } else { 1.0 };
        let moved = turned / cable.displacement_rad;
        let half = z + 0.5 * moved * slope(z);
        (z + moved * slope(half)).clamp(-1.0, 1.0)
    }

    #[inline(always)]
    fn float_nm(&self, now: &Now) -> f64 {
        self.physics.float_nm + self.physics.float_kg_m * now.accel[0]
    }

    #[inline(always)]
    fn command_nm(&self, x: &[f64; N]) -> f64 {
        if N == PLAIN { x[TORQUE] } else { self.command.iter().zip(x).map(|(share, x)| share * x).sum() }
    }

    #[inline(always)]
    fn motor(&self, command_nm: f64) -> f64 {
        let limit = self.physics.limit_nm.unwrap_or(f64::INFINITY);
        let clamped = command_nm.clamp(-limit, limit);
        clamped - clamped.clamp(-self.physics.dead_zone_nm, self.physics.dead_zone_nm)
    }

    #[inline(always)]
    fn seen(&self, theta: f64) -> f64 {
        let quantum = self.physics.quantum_rad;
        if quantum > 0.0 { quantum * (theta / quantum).round() } else { theta }
    }

    /// The float meets a stop, or leaves it.
    #[inline(always)]
    fn contact(&self, state: &mut Running<N>) {
        let gyro = &self.physics.config.gyro;
        if state.stop == 0 {
            if state.x[THETA].abs() >= gyro.stop_angle_rad && state.x[THETA] * state.x[THETA_RATE] > 0.0 {
                state.stop = if state.x[THETA] > 0.0 { 1 } else { -1 };
                state.x[THETA] = gyro.stop_angle_rad * f64::from(state.stop);
                state.x[THETA_RATE] = 0.0;
            }
        } else if (gyro.angular_momentum_nm_s * state.x[PHI_RATE] + state.u[1]) * f64::from(state.stop) < 0.0 {
            state.stop = 0;
        }
    }
}

#[inline(always)]
fn sign(value: f64) -> f64 {
    if value > 0.0 {
        1.0
    } else if value < 0.0 {
        -1.0
    } else {
        0.0
    }
}
