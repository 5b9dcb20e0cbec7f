//! Torques and errors of sensors that an effect might be, in groups by what they are functions of.

use super::group::{Group, On};
use super::lines::{Carrier, line};
use super::moments::moments;
use super::on_float::changes;
use crate::fit::{Fit, Problem};
use crate::record::Signal;

/// Rms of each torque on the gimbal [N m], and of each drift of the float [rad/s].
const UNIT_NM: f64 = 1e-4;
const UNIT_RADPS: f64 = 1e-4;
/// Ways in which presliding or a cable yields [rad].
const YIELDS_RAD: [f64; 5] = [3e-4, 1e-3, 3e-3, 1e-2, 3e-2];
/// Times for which an angle is remembered [s].
const REMEMBERED_S: [f64; 4] = [0.3, 1.0, 4.0, 15.0];
/// Time over which a change of the cross rate is taken, for its noise [s].
const QUICK_S: f64 = 0.01;
/// Time constant of a motor's heat [s].
const HEAT_S: f64 = 5.0;
/// Rate that is none, over the noise of a logged one.
const AT_REST: f64 = 4.0;
/// Torque over its rms within which its sign is no step.
const SOFT: f64 = 0.02;

/// What noise takes of torques that are functions of something, more than its spectrum says, as the bearing turns around
/// most of the time and as it does not; and what it takes of slow ones, as it wanders [nats].
const WARY_NATS: [f64; 2] = [18.0, 0.0];
const WANDERS_NATS: [f64; 2] = [40.0, 12.0];
const SLOW: [&str; 2] = ["time", "specific force"];

type Series = Vec<f64>;
type Functions = (&'static str, Vec<Series>);

/// Every group at a fit.
pub(crate) fn groups(problem: &Problem, fit: &Fit) -> Vec<Group> {
    let motion = Motion::new(problem, fit);
    let mut functions = motion.of_angle_and_time();
    functions.extend(motion.of_slip());
    functions.extend(motion.of_motor());
    functions.extend(motion.of_specific_force());
    let way = usize::from(!problem.turns_mostly);
    let choice = |of: &str| if SLOW.contains(&of) { WANDERS_NATS[way] } else { WARY_NATS[way] };
    let grouped = |functions: Vec<Functions>, on: On| {
        functions.into_iter().map(move |(of, series)| Group { of, choice: choice(of), series, on })
    };
    let mut groups: Vec<Group> = grouped(functions, On::Gimbal).chain(grouped(motion.of_float(), On::Float)).collect();
    for (signal, functions) in motion.of_readings() {
        if problem.record.channel(signal).is_some() {
            groups.extend(grouped(vec![functions], On::Reading(signal)));
        }
    }
    let drive = problem.path.drive(&problem.whitener, &fit.residual);
    let lines = motion.carriers().into_iter().filter_map(|carrier| line(problem, &drive, &carrier));
    groups.extend(lines.map(|line| Group { choice: line.choice + WARY_NATS[way], ..line }));
    groups.extend(moments(problem, fit, &drive));
    for group in &mut groups {
        let unit = match group.on {
            On::Gimbal => UNIT_NM,
            On::Float => UNIT_RADPS,
            On::Reading(signal) => noise(problem, signal),
        };
        for own in &mut group.series {
            *own = scaled(own).iter().map(|value| unit * value).collect();
        }
    }
    groups
}

/// Rms of the noise of a sensor.
fn noise(problem: &Problem, signal: Signal) -> f64 {
    let mut channels = problem.record.channels.iter().zip(&problem.noise);
    channels.find(|(own, _)| own.signal == signal).map_or(1.0, |(_, noise)| *noise)
}

/// What the platform does.
struct Motion<'a> {
    period_s: f64,
    /// rel [rad].
    rel: Series,
    /// The same from -1 to 1, and the time.
    angle: Series,
    time: Series,
    /// Slip rate over its rms, and its sign.
    slip: Series,
    sign: Series,
    /// Motor torque as it is and over its rms.
    torque_nm: &'a [f64],
    torque: Series,
    load: Series,
    accel: [Series; 3],
    cross: Option<Series>,
    /// theta, and phi'.
    float: Series,
    turning: Series,
}

impl<'a> Motion<'a> {
    fn new(problem: &Problem, fit: &'a Fit) -> Self {
        let inputs = &problem.record.inputs;
        let (rel, slip) = (inputs.rel_rad(&fit.prediction), inputs.slip_radps(&fit.prediction));
        // of a bearing at rest the logged rate is its noise, which friction has made a torque of
        let at_rest = AT_REST * problem.record.rate_noise.rms_radps;
        let slip: Series = slip.iter().map(|slip| slip - slip.clamp(-at_rest, at_rest)).collect();
        let soft = problem.base.config.bearing.slip_rate_radps;
        let rows: Series = (0..inputs.len()).map(|k| k as f64).collect();
        Self {
            period_s: inputs.period_s,
            angle: unit(&rel),
            rel,
            time: unit(&rows),
            sign: slip.iter().map(|slip| (slip / soft).clamp(-1.0, 1.0)).collect(),
            slip: scaled(&slip),
            torque_nm: &fit.prediction.motor_torque_nm,
            torque: scaled(&fit.prediction.motor_torque_nm),
            load: scaled(&inputs.load_nm),
            accel: inputs.accel_mps2.each_ref().map(|axis| scaled(axis)),
            cross: (!inputs.cross_radps.is_empty()).then(|| scaled(&inputs.cross_radps)),
            float: scaled(&fit.prediction.gyro_angle_rad),
            turning: scaled(&fit.prediction.gimbal_rate_radps),
        }
    }

    fn of_angle_and_time(&self) -> Vec<Functions> {
        vec![
            ("gimbal angle", series(&self.angle, 8)),
            ("gimbal angle and direction", each(&self.sign, &series(&self.angle, 5))),
            ("gimbal angle that was", REMEMBERED_S.map(|tau_s| self.followed(&self.rel, tau_s)).to_vec()),
            ("way since it turned around", YIELDS_RAD.map(|span_rad| self.yielded(span_rad)).to_vec()),
            ("time", series(&self.time, 12)),
            ("time and direction", each(&self.sign, &series(&self.time, 8))),
        ]
    }

    fn of_slip(&self) -> Vec<Functions> {
        let mut rates: Vec<Series> = [0.33, 0.66, 1.0, 2.0].map(|exponent| odd(&self.slip, exponent)).to_vec();
        rates.extend([0.5, 1.0, 2.0].map(|exponent| even(&self.slip, exponent)));
        rates.push(self.sign.clone());
        let loads = [0.5, 1.0, 2.0].map(|exponent| odd(&self.load, exponent)).to_vec();
        vec![("slip rate", rates), ("load", each(&self.sign, &loads))]
    }

    fn of_motor(&self) -> Vec<Functions> {
        let torque = &self.torque;
        let soft = torque.iter().map(|value| (value / SOFT).clamp(-1.0, 1.0)).collect();
        let shapes = vec![even(torque, 1.0), even(torque, 2.0), odd(torque, 2.0), odd(torque, 3.0), soft];
        let heat = self.followed(&product(self.torque_nm, self.torque_nm), HEAT_S);
        vec![
            ("motor torque", shapes),
            ("motor torque and time", each(torque, &series(&self.time, 6))),
            ("motor torque and gimbal angle", each(torque, &series(&self.angle, 4))),
            ("heat of the motor", vec![product(&heat, torque), product(&heat, &self.sign), heat]),
        ]
    }

    fn of_specific_force(&self) -> Vec<Functions> {
        let [x, y, z] = &self.accel;
        let mut forces = vec![x.clone(), y.clone(), z.clone()];
        forces.extend([(x, y), (y, z), (z, x), (x, x), (y, y), (z, z)].map(|(a, b)| product(a, b)));
        let mut groups = vec![("specific force", forces)];
        if let Some(cross) = &self.cross {
            groups.push(("cross rate", vec![cross.clone(), product(cross, cross), product(cross, &self.slip)]));
        }
        groups
    }

    /// Torques on the float: of its angle, of that and specific force; of which way it turns; of the cross rate, which a gyro
    /// out of line sees, of how fast that changes, as the float's inertia about its axis feels it, and of its product with
    /// the slip rate.
    fn of_float(&self) -> Vec<Functions> {
        let float = &self.float;
        let angles = [float.clone(), even(float, 2.0), odd(float, 2.0), odd(float, 3.0)];
        let tilted = self.accel.each_ref().map(|axis| product(axis, float));
        let turns = scaled(&changes(float));
        let way = turns.iter().map(|rate| (rate / SOFT).clamp(-1.0, 1.0)).collect();
        let mut groups = vec![
            ("gyro angle", angles.to_vec()),
            ("gyro angle and specific force", tilted.to_vec()),
            ("which way the float turns", vec![way, even(&turns, 1.0)]),
        ];
        if let Some(cross) = &self.cross {
            let quickly = changes(&self.followed(cross, QUICK_S));
            groups.push(("cross rate, to the gyro", vec![cross.clone(), quickly, product(cross, &self.slip)]));
        }
        groups
    }

    /// Errors of a sensor: of what it reads, and of how fast that changes, as one that answers late has.
    fn of_readings(&self) -> [(Signal, Functions); 2] {
        let errors = |of: &[f64]| vec![even(of, 2.0), odd(of, 2.0), odd(of, 3.0), changes(of)];
        [
            (Signal::GyroAngle, ("what the pick-off reads", errors(&self.float))),
            (Signal::MotorTorque, ("what the torque sensor reads", errors(&self.torque))),
        ]
    }

    /// What may beat in time: a torque, the motor's torque, friction, the gyro's wheel.
    fn carriers(&self) -> [Carrier; 4] {
        let ones = vec![1.0; self.time.len()];
        [
            ("a line in time", ones, On::Gimbal),
            ("motor torque and a line in time", self.torque.clone(), On::Gimbal),
            ("direction and a line in time", self.sign.clone(), On::Gimbal),
            ("gyro's rate and a line in time", self.turning.clone(), On::Float),
        ]
        .map(|(of, series, on)| Carrier { of, series, on })
    }

    /// A first-order lag.
    fn followed(&self, of: &[f64], tau_s: f64) -> Series {
        let share = (self.period_s / tau_s).min(1.0);
        let mut state = of.first().copied().unwrap_or(0.0);
        of.iter()
            .map(|x| {
                state += (x - state) * share;
                state
            })
            .collect()
    }

    /// A spring that yields, over its limit.
    fn yielded(&self, span_rad: f64) -> Series {
        let (mut state, mut last) = (0.0, self.rel.first().copied().unwrap_or(0.0));
        self.rel
            .iter()
            .map(|rel| {
                state = f64::clamp(state + (rel - last) / span_rad, -1.0, 1.0);
                last = *rel;
                state
            })
            .collect()
    }
}

/// Chebyshev's polynomials from the first on, of what lies between -1 and 1.
fn series(of: &[f64], orders: u32) -> Vec<Series> {
    (1..=orders)
        .map(|order| of.iter().map(|x| (f64::from(order) * x.clamp(-1.0, 1.0).acos()).cos()).collect())
        .collect()
}

fn each(factor: &[f64], group: &[Series]) -> Vec<Series> {
    group.iter().map(|own| product(factor, own)).collect()
}

fn product(a: &[f64], b: &[f64]) -> Series {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

fn odd(of: &[f64], exponent: f64) -> Series {
    of.iter().map(|x| x.abs().powf(exponent) * x.signum()).collect()
}

fn even(of: &[f64], exponent: f64) -> Series {
    of.iter().map(|x| x.abs().powf(exponent)).collect()
}

/// From -1 to 1.
fn unit(values: &[f64]) -> Series {
    let (low, high) =
        values.iter().fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(*value), high.max(*value)));
    let half = (0.5 * (high - low)).max(1e-12);
    values.iter().map(|value| (value - low) / half - 1.0).collect()
}

/// Of unit rms.
fn scaled(values: &[f64]) -> Series {
    let square: f64 = values.iter().map(|value| value * value).sum();
    let by = 1.0 / (square / values.len().max(1) as f64).sqrt().max(1e-12);
    values.iter().map(|value| value * by).collect()
}
