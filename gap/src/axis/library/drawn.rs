//! What the motion draws of an effect.

use super::{NOMINAL, Shape};
use crate::axis::memory::{Yields, dahl_state};
use crate::axis::motion::Motion;
use crate::axis::resonance;

impl Shape {
    /// The shapes of the effect at every row, one for each amplitude.
    pub(in crate::axis) fn columns(&self, m: &Motion) -> Vec<Vec<f64>> {
        let by = |f: &dyn Fn(usize) -> f64| (0..m.q.len()).map(f).collect::<Vec<f64>>();
        let waves = |k: f64, carrier: &dyn Fn(usize) -> f64| {
            vec![by(&|i| carrier(i) * (k * m.q[i]).cos()), by(&|i| carrier(i) * (k * m.q[i]).sin())]
        };
        let warm = |time_s: f64, i: usize| 1.0 - (-m.time_s(i) / time_s).exp();
        let (size, middle, nominal) = (m.size, m.middle, m.nominal);
        match *self {
            Self::Inertia => vec![m.a.clone()],
            Self::Viscous => vec![m.v.clone()],
            Self::Coulomb => vec![m.s.clone()],
            Self::Scale => vec![by(&|i| nominal[0] * m.a[i] + nominal[1] * m.v[i] + nominal[2] * m.s[i])],
            Self::Constant => vec![vec![1.0; m.q.len()]],
            // once it slips it is an offset; rows of rest, which would tell, are not in the balance
            Self::Asymmetry => vec![vec![1.0; m.q.len()]],
            Self::DragAsymmetry => vec![by(&|i| (nominal[1] * m.v[i] + nominal[2] * m.s[i]).abs())],
            Self::Stribeck { rate, exponent } => {
                vec![by(&|i| m.s[i] * (-(m.v[i].abs() / rate).powf(exponent)).exp())]
            }
            Self::Presliding { displacement, yields } => {
                let z = match yields {
                    Yields::One => dahl_state(&m.q, displacement),
                    _ => yields.state(&m.q, displacement),
                };
                vec![by(&|i| z[i] - m.s[i])]
            }
            Self::Quadratic => vec![by(&|i| m.v[i] * m.v[i].abs())],
            Self::ViscousCurve { exponent } => vec![by(&|i| m.s[i] * m.v[i].abs().powf(exponent))],
            Self::FrictionDrift { time_s } => vec![by(&|i| m.s[i] * warm(time_s, i))],
            Self::ViscousDrift { time_s } => vec![by(&|i| m.v[i] * warm(time_s, i))],
            Self::BiasDrift { time_s } => vec![by(&|i| warm(time_s, i))],
            Self::LoadDependence => vec![by(&|i| m.s[i] * m.needed[i].abs())],
            Self::InertialLoad => vec![by(&|i| m.s[i] * m.a[i].abs())],
            Self::PositionFriction { wave_number } => waves(wave_number, &|i| m.s[i]),
            Self::FrictionTaper => vec![by(&|i| m.s[i] * (m.q[i] - middle))],
            // where it is slack is not known
            Self::Spring => vec![by(&|i| m.q[i] - middle), vec![1.0; m.q.len()]],
            Self::Hysteresis { width, yields } => vec![yields.state(&m.q, 0.5 * width)],
            Self::Ripple { wave_number } => waves(wave_number, &|_| 1.0),
            Self::MotorRipple { wave_number } => waves(wave_number, &|i| m.needed[i]),
            // what the effort needed is of has friction in the place of the dead zone
            Self::DeadZone => {
                let effort = m.whole.apply(&m.effort);
                vec![by(&|i| (effort[i] / (0.02 * size)).clamp(-1.0, 1.0))]
            }
            Self::TorqueCurve => vec![by(&|i| (m.needed[i] / size).powi(3))],
            Self::RateDelay => vec![m.a.clone()],
            Self::Lag => vec![m.derivative(&m.whole.apply(&m.needed))],
            Self::Flexible => vec![m.derivative(&m.derivative(&m.rest.apply(&m.a)))],
            Self::Mode { frequency_hz, damping } => vec![resonance::column(&m.a, m.period_s, frequency_hz, damping)],
            Self::Backlash(play) => {
                let push = play.push(m);
                vec![by(&|i| push[i] - m.a[i] - play.slowing * m.s[i])]
            }
            Self::Load { channel } => vec![m.auxiliary[channel].1.clone()],
            Self::LoadFriction { channel } => vec![by(&|i| m.s[i] * m.auxiliary[channel].1[i])],
            Self::LoadRipple { channel, wave_number } => waves(wave_number, &|i| m.auxiliary[channel].1[i]),
            Self::LoadGain { channel } => {
                vec![by(&|i| m.needed[i] * (m.auxiliary[channel].1[i] - m.references[channel]))]
            }
        }
    }

    /// The shapes on the grid of the balance.
    pub(in crate::axis) fn on_grid(&self, m: &Motion) -> Vec<Vec<f64>> {
        if *self == Self::Scale {
            let own: Vec<Vec<f64>> = NOMINAL.iter().flat_map(|shape| shape.on_grid(m)).collect();
            let sum = |row: usize| own.iter().zip(m.nominal).map(|(column, nominal)| nominal * column[row]).sum();
            return vec![(0..m.rows.len()).map(sum).collect()];
        }
        let smoothed = matches!(self, Self::Inertia | Self::Viscous | Self::Mode { .. });
        self.columns(m).iter().map(|column| if smoothed { m.smoothed(column) } else { m.raw(column) }).collect()
    }
}
