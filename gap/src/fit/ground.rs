//! What a log and a model give before anything is taken for noise: nominal prediction, sensitivities to everything, what
//! a torque on the gimbal does.

use std::sync::{Arc, OnceLock};

use gimbal_model_file::ModelFile;

use super::blocks::{Turned, Turning};
use super::draft::Draft;
use super::path::Path;
use super::plans::Plans;
use super::resonance;
use super::rest::{Raw, rest};
use super::ripple;
use super::shapes::{Impulse, Shapes};
use super::signals::{Kept, Signals, peak, residual, scaled, valid};
use super::slip::Slips;
use super::turning::{at_once, impulse, mostly, nearly_turns, remembered, turning_noise, turns};
use super::whiten::Loop;
use super::{Columns, Fit, Problem, Whitener};
use crate::library::{Candidate, Nuisance, Offer, candidates, hold, narrow, not_looked_for, nuisances, platform};
use crate::record::{Channel, Record, Signal, least_noise, rough};
use crate::simulate::{Begin, Physics, Prediction, predict};

/// Problems under any noise are made from this.
pub(crate) struct Ground<'a> {
    record: &'a Record,
    stop_rad: f64,
    base: Physics,
    begin: Begin,
    nominal: Prediction,
    /// Rms of the noise of each channel, and one over it.
    noise: Vec<f64>,
    over_noise: Vec<f64>,
    nuisances: Vec<Nuisance>,
    /// All but those whose lines show in what is left.
    candidates: Vec<Candidate>,
    not_looked_for: Vec<&'static str>,
    offer: Offer,
    columns: Columns,
    sigma: Vec<f64>,
    /// Sensitivities and nominal residual over the noise.
    raw: Vec<Kept>,
    target: Signals,
    plans: Plans,
    /// The loop of the nominal platform.
    behind: Behind,
    valid: Vec<bool>,
    /// Rows at which the bearing turns around, or nearly does, and what the noise of the rate does there.
    turns: Vec<bool>,
    nearly_turns: Vec<bool>,
    turned: OnceLock<Turned>,
    /// What the nominal parameters and a few effects do not explain.
    rest: OnceLock<Signals>,
}

/// What fits leave of a log.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    /// The closest one: noise.
    pub(crate) noise: Signals,
    /// The nominal parameters alone: what lines are looked for in.
    pub(crate) gap: Signals,
    /// The platform behind that noise.
    pub(crate) platform: Fitted,
}

/// What noise looks like behind a loop.
#[derive(Debug)]
struct Behind {
    impulse: Impulse,
    shapes: Arc<Vec<Shapes>>,
}

impl Behind {
    fn new(physics: &Physics, record: &Record, over_noise: &[f64], plans: &Plans) -> Self {
        let impulse = impulse(physics, record, over_noise);
        let signals: Vec<Signal> = record.channels.iter().map(|channel| channel.signal).collect();
        let shapes = Arc::new(Shapes::of(&impulse, &signals, plans, record.inputs.period_s));
        Self { impulse, shapes }
    }
}

/// A platform as it was fitted. A few per cent of the loop's frequency, a tolerance, are a fifth of what is left of a pulse
/// after a period of it.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    physics: Physics,
    begin: Begin,
    prediction: Prediction,
}

impl From<&Fit> for Fitted {
    fn from(fit: &Fit) -> Self {
        Self { physics: fit.physics.clone(), begin: fit.begin.clone(), prediction: fit.prediction.clone() }
    }
}

impl<'a> Ground<'a> {
    /// Predicts and differentiates.
    pub(crate) fn new(record: &'a Record, model: &ModelFile) -> Self {
        let mut base = platform(model);
        let not_looked_for = not_looked_for(model);
        base.config.period_s = record.inputs.period_s;
        base.motor_noise_nm = record.motor_noise_nm;
        // the float goes as far as the log shows that it goes
        let reached = record.channel(Signal::GyroAngle).map_or(0.0, |channel| peak(&channel.values));
        base.config.gyro.stop_angle_rad =
            record.plateau_rad.unwrap_or(base.config.gyro.stop_angle_rad.max(1.2 * reached));
        let begin = record.begin(&base, &record.inputs);
        let nominal = predict(&base, &record.inputs, &begin, record.rows());
        let target = residual(record, &nominal);
        let noise = |(raw, channel): (&Vec<f64>, &Channel)| {
            rough(raw, &channel.valid).max(least_noise(&channel.values, &channel.valid))
        };
        let noise: Vec<f64> = target.iter().zip(&record.channels).map(noise).collect();
        let over_noise: Vec<f64> = noise.iter().map(|noise| 1.0 / noise).collect();
        let mut nuisances = nuisances(&model.tolerance, &base);
        hold(&mut nuisances, &model.known_good);
        let offer = offer(record, &nominal);
        let mut candidates = candidates(&record.inputs, &offer);
        candidates.retain(|candidate| !not_looked_for.contains(&candidate.effect));
        let draft = Draft { record, base: &base, begin: &begin, nominal: &nominal, over_noise: &over_noise };
        let (columns, raw, sigma) = draft.columns(&nuisances, &candidates);
        let plans = Whitener::plans_of(record.rows());
        Self {
            record,
            stop_rad: model.config.gyro.stop_angle_rad,
            target: scaled(target, &over_noise),
            behind: Behind::new(&base, record, &over_noise, &plans),
            plans,
            valid: valid(record),
            turns: turns(&base, record, &nominal),
            nearly_turns: nearly_turns(&base, record, &nominal),
            base,
            begin,
            nominal,
            noise,
            over_noise,
            nuisances,
            candidates,
            not_looked_for,
            offer,
            columns,
            sigma,
            raw,
            turned: OnceLock::new(),
            rest: OnceLock::new(),
        }
    }

    fn rest(&self) -> &Signals {
        self.rest.get_or_init(|| {
            let raw = Raw { columns: &self.raw, layout: &self.columns, sigma: &self.sigma, valid: &self.valid };
            rest(&raw, &self.target)
        })
    }

    /// The first noise behind the platform as it was fitted under it; none where that is no matter.
    pub(crate) fn known_behind(&self, fit: &Fit) -> Option<Known> {
        if self.turned.get().is_none_or(Turned::is_empty) {
            return None;
        }
        let rest = scaled(self.rest().clone(), &self.noise);
        Some(Known { noise: rest.clone(), gap: rest, platform: fit.into() })
    }

    /// Under the noise that what is known to be left shows; without it, under what the nominal parameters and a few effects
    /// do not explain. Its columns are those of the beginning and of the nominal parameters.
    pub(crate) fn problem(&self, known: Option<Known>) -> Problem<'a> {
        let (noise, gap, platform) = match known {
            None => (self.rest().clone(), self.rest().clone(), None),
            Some(Known { noise, gap, platform }) => {
                (scaled(noise, &self.over_noise), scaled(gap, &self.over_noise), Some(platform))
            }
        };
        let as_fitted =
            platform.as_ref().map(|own| Behind::new(&own.physics, self.record, &self.over_noise, &self.plans));
        let behind = as_fitted.as_ref().unwrap_or(&self.behind);
        let whitener = self.whitener(&noise, platform.as_ref(), &behind.shapes);
        let impulse = &behind.impulse;
        let path = Path::new(&whitener, &impulse.channels, impulse.torque_nm, self.record.inputs.period_s);
        let (mut candidates, mut columns, mut sigma) =
            (self.candidates.clone(), self.columns.clone(), self.sigma.clone());
        let mut probes = self.raw.len();
        for candidate in self.narrow(&path, &whitener, [&gap, &noise]) {
            columns.first.push(probes);
            probes += candidate.probes.len();
            sigma.extend(candidate.prior.iter().map(|(_, sigma)| *sigma));
            candidates.push(candidate);
        }
        let mut problem = Problem {
            record: self.record,
            stop_rad: self.stop_rad,
            base: self.base.clone(),
            begin: self.begin.clone(),
            nuisances: self.nuisances.clone(),
            candidates,
            not_looked_for: self.not_looked_for.clone(),
            columns,
            whitened: Vec::new(),
            gram: nalgebra::DMatrix::zeros(0, 0),
            impulse_nm: impulse.torque_nm,
            shapes: behind.shapes.clone(),
            whitener,
            path,
            turns_mostly: mostly(&self.turns),
            turns: self.nearly_turns.clone(),
            noise: self.noise.clone(),
            ceiling_nm: self.offer.sees_torque.then_some(self.offer.peak_torque_nm),
            sigma,
        };
        let fixed = self.columns.begin + self.columns.nuisances;
        problem.add_columns(&self.raw[..fixed], &[]);
        problem
    }

    /// With the columns of the candidates, too, which are for a search alone; where it has them, it is left.
    pub(crate) fn complete(&self, problem: &mut Problem) {
        let has = problem.whitened.len();
        if has > self.columns.begin + self.columns.nuisances {
            return;
        }
        let narrow = &problem.candidates[self.candidates.len()..];
        let probes = narrow.iter().flat_map(|candidate| self.draft().probes(candidate)).collect();
        let more = self.draft().differences(probes);
        problem.add_columns(self.raw.get(has..).unwrap_or_default(), &more);
    }

    /// Gives back what only another problem would need.
    pub(crate) fn forget(&mut self) {
        self.raw = Vec::new();
        self.turned = OnceLock::new();
        self.rest = OnceLock::new();
    }

    fn draft(&self) -> Draft<'_> {
        let (base, begin, nominal) = (&self.base, &self.begin, &self.nominal);
        Draft { record: self.record, base, begin, nominal, over_noise: &self.over_noise }
    }

    fn whitener(&self, rest: &Signals, platform: Option<&Fitted>, shapes: &[Shapes]) -> Whitener {
        let (base, record, nominal, turns) = (&self.base, self.record, &self.nominal, &self.turns);
        let turning_noise = if at_once(turns) { 0.0 } else { turning_noise(base, record, nominal, turns) };
        let (period_s, rate_noise) = (record.inputs.period_s, &record.rate_noise);
        let turning = &remembered(turns);
        let plans = &self.plans;
        let behind = Loop { plans, shapes, turning, turning_noise, rate_noise, period_s };
        let turning = |base, begin, nominal| {
            let draft = Draft { record, base, begin, nominal, over_noise: &self.over_noise };
            Turning { draft, turns }.turned()
        };
        let as_fitted = platform.map(|own| turning(&own.physics, &own.begin, &own.prediction));
        let turned =
            as_fitted.as_ref().unwrap_or_else(|| self.turned.get_or_init(|| turning(base, &self.begin, nominal)));
        let rest = &turned.released().without(rest);
        let whitener = Whitener::new(rest, &self.valid, behind);
        if mostly(turns) && turned.is_empty() {
            return whitener;
        }
        // what the turns do is no noise of any frequency: that is measured again without it
        let first = Slips::new(turned, record, rest, |signals| whitener.filter(signals));
        let whitener = whitener.with_slips(first).measured_again(rest, behind);
        let slips = Slips::new(turned, record, rest, |signals| whitener.filter(signals));
        whitener.with_slips(slips)
    }

    /// Effects whose lines are too narrow for a grid, where they stand out of what the nominal parameters leave, and of what
    /// the closest fit does.
    fn narrow(&self, path: &Path, whitener: &Whitener, rests: [&Signals; 2]) -> Vec<Candidate> {
        let inputs = &self.record.inputs;
        let (period_s, rel_rad) = (inputs.period_s, inputs.rel_rad(&self.nominal));
        let (mut cycles, mut modes): (Vec<f64>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
        let rests = if rests[0] == rests[1] { &rests[..1] } else { &rests[..] };
        for rest in rests {
            let drive = path.drive(whitener, &whitener.apply(rest));
            ripple::add_cycles(&mut cycles, path, &drive, &rel_rad, &self.valid, period_s);
            resonance::add_modes(&mut modes, path, whitener, &drive, &self.nominal.gimbal_rate_radps, period_s);
        }
        let mut narrow = narrow(&cycles, &modes);
        narrow.retain(|candidate| !self.not_looked_for.contains(&candidate.effect));
        narrow
    }
}

/// What the log offers to the effects.
fn offer(record: &Record, nominal: &Prediction) -> Offer {
    let sees = |signal| record.channel(signal).is_some();
    Offer {
        peak_torque_nm: record
            .channel(Signal::MotorTorque)
            .map_or_else(|| peak(&nominal.motor_torque_nm), Channel::held_peak),
        sees_torque: sees(Signal::MotorTorque),
        sees_cross: !record.inputs.cross_radps.is_empty(),
    }
}
