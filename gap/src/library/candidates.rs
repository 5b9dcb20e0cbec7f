//! How the signature of every effect is looked for: probes of the prediction, on a small grid of what is not linear.

use gimbal_plant::{Bound, Effect};

use super::apply::WOUND;
use crate::simulate::Inputs;

/// One way in which an effect may show: its columns, and what their amplitudes mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The effect.
    pub effect: &'static str,
    /// Values of the effect for each column, and what its difference to the base is divided by.
    pub probes: Vec<(Vec<f64>, f64)>,
    /// Prior of each amplitude: mean and standard deviation.
    pub prior: Vec<(f64, f64)>,
    /// Nominal parameters that are set free instead of new columns.
    pub releases: &'static [&'static str],
    /// Candidates of the same effect: what the search over them costs is its logarithm.
    pub siblings: usize,
}

/// Evidence that linear equations must promise for a fit, and for that of a nominal parameter beyond its tolerance [nats].
pub(crate) const PROMISE: f64 = 8.0;
/// Evidence that an effect must bring to be named; a nominal parameter beyond its tolerance needs less [nats].
pub(crate) const NAMED: f64 = 18.0;
const PROMISE_OF_SHIFT: f64 = 3.0;
/// Effects that are not linear in their size, and the least and the largest share of the size at which they are tried that
/// equations may give them.
const NOT_LINEAR: [&str; 4] = ["loop_delay", "presliding", "dead_zone", "torque_saturation"];
const SECANT: [f64; 2] = [0.003, 8.0];

impl Candidate {
    /// Whether linear equations promise enough for a fit.
    pub(crate) fn is_promised(&self, gain: f64) -> bool {
        gain > if self.releases.is_empty() { PROMISE } else { PROMISE_OF_SHIFT }
    }

    /// Whether linear equations that give it such amplitudes may be believed.
    pub(crate) fn holds_at(&self, amplitudes: &[f64]) -> bool {
        let near = |first: &f64| *first > SECANT[0] && *first < SECANT[1];
        !NOT_LINEAR.contains(&self.effect) || amplitudes.first().is_some_and(near)
    }
}

/// Limits of the torque that are tried, over the largest torque.
const CEILINGS_SEEN: [f64; 6] = [1.0, 0.985, 0.965, 0.93, 0.85, 0.7];
const CEILINGS_UNSEEN: [f64; 16] =
    [1.0, 0.99, 0.975, 0.96, 0.945, 0.93, 0.915, 0.9, 0.88, 0.855, 0.82, 0.77, 0.7, 0.6, 0.5, 0.4];

/// Damping at which a mode is looked for.
pub(crate) const MODE_DAMPING: f64 = 0.03;
/// Inertia over damping at which a narrow mode is linear in its inertia: at its peak the appendage acts as
/// `1 / (2 damping)` times its inertia does.
const LINEAR_SHARE: f64 = 0.2;

/// What the log offers to the effects.
#[derive(Debug, Clone, Copy, Default)]
pub struct Offer {
    /// Largest motor torque that was predicted or measured [N m].
    pub peak_torque_nm: f64,
    /// Whether the motor torque is measured.
    pub sees_torque: bool,
    /// Whether the cross rate is.
    pub sees_cross: bool,
}

/// Every candidate for a log.
#[must_use]
pub fn candidates(inputs: &Inputs, offer: &Offer) -> Vec<Candidate> {
    let mut all = Vec::new();
    for effect in Effect::all() {
        all.extend(of(effect, inputs, offer));
    }
    all
}

fn of(effect: Effect, inputs: &Inputs, offer: &Offer) -> Vec<Candidate> {
    let name = effect.name();
    let seconds = inputs.len() as f64 * inputs.period_s;
    match name {
        // a scale of the torque shows where the torque is measured
        "torque_scale" if !offer.sees_torque => Vec::new(),
        // the pick-off shows the stop itself, and its steps; ripple is too narrow for a grid
        "stop_angle" | "pickoff_quantisation" | "torque_ripple" => Vec::new(),
        _ if !releases(name).is_empty() => vec![released(effect, releases(name))],
        "torque_bias" if !offer.sees_torque => Vec::new(),
        "cross_axis_coupling" if !offer.sees_cross => Vec::new(),
        // of these the first formulation is looked for: the Gaussian fall, Bouc-Wen's loop
        "stribeck" => formulated(grid(effect, &[0.008, 0.025, 0.08, 0.25].map(|rate| vec![3e-4, rate])), 3),
        "friction_drift" => grid(effect, &[0.12, 0.4, 1.3].map(|share| vec![0.1, share * seconds])),
        "cable_hysteresis" => {
            formulated(grid(effect, &[0.0015, 0.005, 0.015, 0.05, 0.17, 0.5].map(|along| vec![3e-4, along])), 4)
        }
        "flexible_mode" => {
            grid(effect, &[35.0, 60.0, 100.0, 160.0, 250.0, 370.0].map(|hz| vec![0.015, hz, MODE_DAMPING]))
        }
        "presliding" => {
            // in the place of the clamp, on it, and of the load alone
            let mut settings = [3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3].map(|along| vec![along]).to_vec();
            settings.extend([2e-6, 1e-5, 5e-5, 3e-4].map(|along| vec![along, 1.0]));
            settings.extend([1e-4, 6e-4, 3e-3].map(|along| vec![along, 2.0]));
            settings.extend([2e-6, 6e-6, 2e-5, 6e-5, 2e-4].map(|along| vec![along, 3.0]));
            secants(effect, &settings)
        }
        "loop_delay" => secants(effect, &[3e-5, 2e-4].map(|delay_s| vec![delay_s])),
        "dead_zone" => secants(effect, &[3e-5, 1.2e-4, 5e-4].map(|width| vec![width])),
        "torque_saturation" => {
            // a measured torque shows its ceiling; a predicted one does not know where it will be
            let shares: &[f64] = if offer.sees_torque { &CEILINGS_SEEN } else { &CEILINGS_UNSEEN };
            let settings: Vec<Vec<f64>> = shares.iter().map(|share| vec![share * offer.peak_torque_nm]).collect();
            secants(effect, &settings)
        }
        _ => grid(effect, &[effect.typical()]),
    }
}

/// Candidates too narrow for a grid: ripple of so many cycles a revolution, modes of such frequencies [Hz]
/// and damping.
#[must_use]
pub fn narrow(cycles: &[f64], modes: &[[f64; 2]]) -> Vec<Candidate> {
    let ripple = |cycles: &f64| {
        let quarter = std::f64::consts::FRAC_PI_2;
        let probes = vec![(vec![1e-4, *cycles, 0.0], 1e-4), (vec![1e-4, *cycles, quarter], 1e-4)];
        Candidate { effect: "torque_ripple", probes, prior: vec![(0.0, 5e-4); 2], releases: &[], siblings: 100 }
    };
    let mode = |[hz, damping]: &[f64; 2]| {
        let share = LINEAR_SHARE * damping;
        let probes = vec![(vec![share, *hz, *damping], share)];
        Candidate { effect: "flexible_mode", probes, prior: vec![(0.0, 0.075)], releases: &[], siblings: 400 }
    };
    cycles.iter().map(ripple).chain(modes.iter().map(mode)).collect()
}

/// The nominal parameters that an effect shifts; none where it adds something.
pub(crate) fn releases(effect: &str) -> &'static [&'static str] {
    match effect {
        "friction_level" => &["friction_level"],
        "mass_unbalance" => &["unbalance x", "unbalance y"],
        "loop_gain" => &["loop_gain"],
        "motor_lag" => &["motor_lag"],
        "gyro_damping" => &["gyro_damping"],
        "angular_momentum" => &["angular_momentum"],
        "gimbal_inertia" => &["gimbal_inertia"],
        "pickoff_scale" => &["pickoff_scale"],
        "torque_scale" => &["torque_scale"],
        _ => &[],
    }
}

/// A standard deviation that spans the realistic range of a parameter.
fn spread(effect: Effect, index: usize) -> f64 {
    let parameter = effect.parameters()[index];
    0.5 * parameter.low.abs().max(parameter.high.abs())
}

fn released(effect: Effect, releases: &'static [&'static str]) -> Candidate {
    let prior = (0..releases.len()).map(|index| (0.0, spread(effect, index))).collect();
    Candidate { effect: effect.name(), probes: Vec::new(), prior, releases, siblings: 1 }
}

/// The first of so many formulations: the others are tried where it gains.
fn formulated(mut settings: Vec<Candidate>, formulations: usize) -> Vec<Candidate> {
    for own in &mut settings {
        own.siblings *= formulations;
    }
    settings
}

/// Linear in the sizes; one candidate for each setting of the rest.
fn grid(effect: Effect, settings: &[Vec<f64>]) -> Vec<Candidate> {
    let one = |values: &Vec<f64>| {
        let probes = (0..effect.sizes())
            .map(|size| {
                let mut probe = values.clone();
                for (other, value) in probe.iter_mut().enumerate().take(effect.sizes()) {
                    if other != size {
                        *value = 0.0;
                    }
                }
                let divisor = probe[size];
                (probe, divisor)
            })
            .collect();
        let prior = (0..effect.sizes()).map(|size| (0.0, spread(effect, size))).collect();
        Candidate { effect: effect.name(), probes, prior, releases: &[], siblings: settings.len() }
    };
    settings.iter().map(one).collect()
}

/// Not linear in the size: the difference at one size, in an amplitude near 1.
fn secants(effect: Effect, settings: &[Vec<f64>]) -> Vec<Candidate> {
    settings
        .iter()
        .map(|values| Candidate {
            effect: effect.name(),
            probes: vec![(values.clone(), 1.0)],
            prior: vec![(0.0, 1.5)],
            releases: &[],
            siblings: settings.len(),
        })
        .collect()
}

impl Candidate {
    /// The values of the effect that amplitudes of the columns stand for.
    #[must_use]
    pub fn values(&self, amplitudes: &[f64]) -> Vec<f64> {
        let effect = Effect::from_name(self.effect);
        if !self.releases.is_empty() {
            return amplitudes.to_vec();
        }
        if self.effect == "torque_ripple" {
            let size = amplitudes[0].hypot(amplitudes[1]);
            return vec![size, self.probes[0].0[1], amplitudes[1].atan2(amplitudes[0])];
        }
        let mut values = self.probes[0].0.clone();
        for (index, (probe, divisor)) in self.probes.iter().enumerate() {
            #[allow(clippy::float_cmp, reason = "a divisor of exactly 1 marks a secant")]
            let secant = *divisor == 1.0 && self.probes.len() == 1 && probe[0] != 1.0;
            values[index] = if secant { probe[0] * self.secant_factor(amplitudes[index]) } else { amplitudes[index] };
        }
        if self.effect == "cable_hysteresis" {
            values.resize(WOUND + 1, 0.0);
        }
        if let Some(effect) = effect {
            for (value, parameter) in values.iter_mut().zip(effect.parameters()) {
                if parameter.bound != Bound::Any {
                    *value = value.max(1e-3 * parameter.low);
                }
            }
        }
        values
    }

    /// From the amplitude of a secant to a factor of its size.
    fn secant_factor(&self, amplitude: f64) -> f64 {
        match self.effect {
            // a higher limit shows less
            "torque_saturation" => (1.0 + 0.02 * (1.0 - amplitude)).clamp(0.97, 1.02),
            _ => amplitude.clamp(0.003, 4.0),
        }
    }
}
