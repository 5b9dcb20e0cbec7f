//! Predictions of a log: one, or many that differ a little.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::chain::{Chain, FULL, PLAIN};
use super::discrete::Steps;
use super::machine::Machine;
use super::{Begin, Inputs, Physics, Prediction};

/// Predictions that go side by side.
const SIDE_BY_SIDE: usize = 4;

/// One of many predictions.
#[derive(Debug, Clone)]
pub struct Variant<'a> {
    /// The platform.
    pub physics: Physics,
    /// Where it begins.
    pub begin: Begin,
    /// The vehicle rate in the place of that of the inputs [rad/s].
    pub rate_radps: Option<&'a [f64]>,
    /// Where its state is pushed.
    pub pushed: Option<Push<'a>>,
    /// Rows that are asked for.
    pub rows: usize,
}

/// A change of the state at some rows, in order.
#[derive(Debug, Clone, Copy)]
pub struct Push<'a> {
    /// The rows.
    pub rows: &'a [usize],
    /// What is added to the state, as it stands in [`Begin`].
    pub by: [f64; PLAIN],
}

/// Runs the physics over the inputs.
#[must_use]
pub fn predict(physics: &Physics, inputs: &Inputs, begin: &Begin, rows: usize) -> Prediction {
    let variant = Variant { physics: physics.clone(), begin: begin.clone(), rate_radps: None, pushed: None, rows };
    let [prediction] = together([&variant], inputs);
    prediction
}

/// Many at once, on all cores, each as it would be by itself: what is made of each.
pub fn predict_each<T: Send>(
    variants: &[Variant],
    inputs: &Inputs,
    make: impl Fn(usize, Prediction) -> T + Sync,
) -> Vec<T> {
    let kind = |index: usize| Kind::of(&variants[index]);
    let mut order: Vec<usize> = (0..variants.len()).collect();
    order.sort_by_key(|&index| kind(index));
    let of_a_kind = order.chunk_by(|&a, &b| kind(a) == kind(b));
    let groups: Vec<&[usize]> = of_a_kind.flat_map(|group| group.chunks(SIDE_BY_SIDE)).collect();
    let run = |group: &&[usize]| -> Vec<(usize, T)> {
        // the last again where some are missing
        let of = |lane: usize| &variants[group[lane.min(group.len() - 1)]];
        let predictions: Vec<Prediction> = match group.len() {
            1 => together([of(0)], inputs).into(),
            2 => together([of(0), of(1)], inputs).into(),
            _ => together::<SIDE_BY_SIDE>(std::array::from_fn(of), inputs).into(),
        };
        group.iter().zip(predictions).map(|(&index, prediction)| (index, make(index, prediction))).collect()
    };
    let mut made: Vec<(usize, T)> = groups.par_iter().with_max_len(1).flat_map_iter(run).collect();
    made.sort_by_key(|(index, _)| *index);
    made.into_iter().map(|(_, made)| made).collect()
}

/// What predictions that go side by side have in common.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    states: usize,
    presliding: bool,
    follows: bool,
    no_bearing: bool,
    rows: usize,
    /// What is slower lane by lane: shapes of friction, cable or ripple, a motor with corners.
    slower: [bool; 3],
}

impl Kind {
    fn of(variant: &Variant) -> Self {
        let physics = &variant.physics;
        Self {
            states: Chain::states(physics),
            presliding: physics.friction.presliding_rad > 0.0,
            follows: physics.friction.follows(),
            no_bearing: physics.config.bearing.count == 0,
            rows: variant.rows,
            slower: [
                physics.friction.per_g != 0.0
                    || physics.friction.stribeck.is_some()
                    || physics.friction.drift.is_some(),
                physics.hysteresis.is_some() || physics.ripple.is_some(),
                physics.has_corners(),
            ],
        }
    }
}

/// Predictions of one kind.
fn together<const L: usize>(variants: [&Variant; L], inputs: &Inputs) -> [Prediction; L] {
    let mut predictions = if Chain::states(&variants[0].physics) == PLAIN {
        run::<PLAIN, L>(variants, inputs)
    } else {
        run::<FULL, L>(variants, inputs)
    };
    for (prediction, variant) in predictions.iter_mut().zip(variants) {
        prediction.logged(&variant.physics, inputs.period_s);
    }
    predictions
}

fn run<const N: usize, const L: usize>(variants: [&Variant; L], inputs: &Inputs) -> [Prediction; L] {
    let steps = variants.map(|own| Steps::<N>::new(&own.physics, inputs.period_s));
    let rates = variants.map(|own| own.rate_radps.unwrap_or(&inputs.rate_radps));
    let machine = Machine::new(steps.each_ref(), inputs, rates);
    let pushed = variants.map(|own| own.pushed);
    Arch::new().dispatch(Run { machine, begin: variants.map(|own| &own.begin), pushed, rows: variants[0].rows })
}

/// A machine that is to run with the widest vectors that there are; bits are the same with all.
struct Run<'a, const N: usize, const L: usize> {
    machine: Machine<'a, N, L>,
    begin: [&'a Begin; L],
    pushed: [Option<Push<'a>>; L],
    rows: usize,
}

impl<const N: usize, const L: usize> WithSimd for Run<'_, N, L> {
    type Output = [Prediction; L];

    // a closure would be compiled for the narrowest
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.machine.run(self.begin, self.pushed, self.rows)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{Push, Variant, predict, predict_each};
    use crate::library::{apply, platform};
    use crate::simulate::{Begin, Inputs, Physics, Prediction};

    fn swayed(rows: usize) -> Inputs {
        shaken(rows, 1e-3, 0.0, 0.0)
    }

    /// With vibration of 40 Hz and a swing of 12 Hz on top.
    fn shaken(rows: usize, period_s: f64, vibration_mps2: f64, swing_radps: f64) -> Inputs {
        let wave = |parts: &[(f64, f64)]| -> Vec<f64> {
            let at = |time_s: f64| parts.iter().map(|(size, hz)| size * (TAU * hz * time_s).sin()).sum();
            (0..rows).map(|k| at(k as f64 * period_s)).collect()
        };
        let mut inputs = Inputs {
            period_s,
            accel_mps2: [
                wave(&[(3.0, 0.7)]),
                wave(&[(5.0, 1.1), (vibration_mps2, 40.0)]),
                wave(&[(9.0, 0.4), (vibration_mps2, 40.0)]),
            ],
            rate_radps: wave(&[(0.3, 2.3), (swing_radps, 12.0)]),
            ..Inputs::default()
        };
        inputs.complete(&gimbal_model_file::ModelFile::default().config.bearing, 0.0);
        inputs
    }

    fn bits(prediction: &Prediction) -> Vec<u64> {
        let of = [&prediction.gyro_angle_rad, &prediction.motor_torque_nm, &prediction.gimbal_angle_rad];
        of.into_iter().flatten().map(|value| value.to_bits()).collect()
    }

    #[test]
    fn closed_form_inputs_along_cubics_are_those_of_eight_times_as_many_rows() {
        let nominal = platform(&gimbal_model_file::ModelFile::default());
        // vibration of a platform without bearings, and bearings that turn around at 12 Hz without it
        for (bearings, vibration_mps2, rate_radps, least) in [(0, 20.0, 0.0, 0.02), (2, 0.0, 0.05, 0.1)] {
            let shake = |rows: usize, period_s: f64| shaken(rows, period_s, vibration_mps2, rate_radps);
            let (lines, fine) = (shake(750, 4e-3), shake(6000, 5e-4));
            let of = |inputs: &Inputs, curved: f64| {
                let mut physics = Physics { curved, ..nominal.clone() };
                physics.config.period_s = inputs.period_s;
                physics.config.bearing.count = bearings;
                predict(&physics, inputs, &Begin::at(&physics, &fine, 0.0, None), usize::MAX).gyro_angle_rad
            };
            let converged = of(&fine, 1.0);
            let off = |curved: f64| {
                let angles = of(&lines, curved);
                let pairs = angles.iter().zip(converged.iter().step_by(8)).skip(250);
                pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>()
            };
            assert!(off(1.0) < least * off(0.0), "{bearings} bearings: {:e} of {:e}", off(1.0), off(0.0));
        }
    }

    #[test]
    fn contract_side_by_side_has_the_bits_of_each_alone() {
        let inputs = swayed(3000);
        let base = platform(&gimbal_model_file::ModelFile::default());
        let begin = Begin::at(&base, &inputs, 0.0, None);
        let mut all: Vec<Physics> = Vec::new();
        for share in [0.0, 0.01, 0.2, 0.9] {
            let mut friction = base.clone();
            friction.friction.load_factor += share;
            let mut stopped = base.clone();
            // some meet the stop, and not at the same time
            stopped.config.gyro.stop_angle_rad *= 0.01 + share;
            all.extend([friction, stopped]);
            for effect in ["stribeck", "presliding", "torque_ripple", "dead_zone", "cable_hysteresis", "flexible_mode"]
            {
                let entry = gimbal_plant::Effect::from_name(effect).expect("an effect");
                let mut own = base.clone();
                own.config.gyro.damping_nm_s_per_rad *= 1.0 + share;
                apply(effect, &entry.typical(), &mut own);
                all.push(own);
            }
            let mut curved = base.clone();
            curved.curved = share;
            all.push(curved);
            let mut following = base.clone();
            following.friction.follows_rad = 1e-6 * share;
            following.friction.sharper = 0.5 * share;
            following.friction.corner.tails = share;
            following.pure_delay = share;
            all.push(following);
            let mut stops = base.clone();
            stops.friction.load_factor += share;
            apply("cable_hysteresis", &[6e-4, 0.05, 1.0], &mut stops);
            all.push(stops);
            for way in [1.0, 2.0, 3.0] {
                let mut own = base.clone();
                own.friction.load_factor += share;
                apply("presliding", &[1e-5, way], &mut own);
                all.push(own);
            }
        }
        let variant = |physics: &Physics| Variant {
            physics: physics.clone(),
            begin: begin.clone(),
            rate_radps: None,
            pushed: None,
            rows: usize::MAX,
        };
        let variants: Vec<Variant> = all.iter().map(variant).collect();
        let together = predict_each(&variants, &inputs, |_, prediction| prediction);
        assert!(together.iter().any(|own| own.on_stop.contains(&true)));
        for (index, (physics, own)) in all.iter().zip(&together).enumerate() {
            assert_eq!(bits(own), bits(&predict(physics, &inputs, &begin, usize::MAX)), "variant {index}");
        }
    }

    #[test]
    fn closed_form_pushed_later_is_begun_later() {
        let (rows, later) = (1200, 200);
        let mut base = platform(&gimbal_model_file::ModelFile::default());
        base.config.bearing.count = 0;
        let zero = || vec![0.0; rows];
        let mut inputs =
            Inputs { period_s: 1e-3, accel_mps2: [zero(), zero(), zero()], rate_radps: zero(), ..Inputs::default() };
        inputs.complete(&base.config.bearing, 0.0);
        let rest = Begin::at(&base, &inputs, 0.0, Some(0.0));
        let by = [1e-3, 1e-5, 1e-3, 1e-4, 1e-3, 1e-3, 1e-3, 1e-5, 1e-5, 1e-4];
        let variant =
            |begin: Begin, pushed| Variant { physics: base.clone(), begin, rate_radps: None, pushed, rows: usize::MAX };
        let push = Push { rows: &[later, 2 * later], by };
        let variants = [variant(Begin { state: by }, None), variant(rest.clone(), Some(push)), variant(rest, None)];
        let [begun, pushed, none] =
            predict_each(&variants, &inputs, |_, own| own.gyro_angle_rad).try_into().expect("three");
        let peak = begun.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
        assert!(none.iter().all(|value| *value == 0.0) && pushed[..later].iter().all(|value| *value == 0.0));
        for k in later..rows {
            let both = begun[k - later] + if k < 2 * later { 0.0 } else { begun[k - 2 * later] };
            assert!((pushed[k] - both).abs() < 1e-9 * peak, "row {k}: {} and {both}", pushed[k]);
        }
    }

    #[test]
    fn closed_form_the_load_that_builds_up_alone_is_all_of_it_or_none() {
        let inputs = swayed(3000);
        let base = platform(&gimbal_model_file::ModelFile::default());
        let begin = Begin::at(&base, &inputs, 0.0, None);
        let torque_nm = |parts: [f64; 2], values: Option<[f64; 2]>| {
            let mut physics = base.clone();
            [physics.friction.load_factor, physics.friction.viscous_factor] = parts;
            if let Some(values) = values {
                apply("presliding", &values, &mut physics);
            }
            predict(&physics, &inputs, &begin, usize::MAX).motor_torque_nm
        };
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let (all, alone) = (Some([1e-3, 0.0]), Some([1e-3, 2.0]));
        // without viscosity there is nothing else, without load nothing builds up
        assert!(apart(&torque_nm([1.0, 0.0], all), &torque_nm([1.0, 0.0], alone)) < 1e-15);
        let viscous = torque_nm([0.0, 1.0], alone);
        let (built_up, clamped) = (torque_nm([0.0, 1.0], all), torque_nm([0.0, 1.0], None));
        assert!(apart(&viscous, &clamped) < 0.02 * apart(&built_up, &clamped));
    }
}
