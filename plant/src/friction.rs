//! Friction on the gimbal, and the zones of the rate in which its law is smooth.

use crate::bearing::Bearings;
use crate::effects::Laws;
use crate::system::Moment;
use crate::vector::{RELATIVE, Vector};

/// A stretch of `w_rel` in which the friction law has no corner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Zone {
    /// Ends of the zone [rad/s].
    pub(crate) low_radps: f64,
    pub(crate) high_radps: f64,
    /// Sign of `w_rel`; 0 in a zone that spans zero.
    pub(crate) sign: f64,
    /// Whether `|w_rel|` is above `w_s`.
    slips: bool,
    /// Whether `|w_rel|` is above the break of the viscous torque.
    fast: bool,
}

/// The zones from the most negative rate to the most positive.
#[derive(Debug, Clone)]
pub(crate) struct Zones(Vec<Zone>);

impl Zones {
    /// `at_zero`: the law has a corner at rest as well.
    pub(crate) fn new(bearings: &Bearings, at_zero: bool) -> Self {
        let mut corners = vec![f64::NEG_INFINITY, f64::INFINITY];
        if bearings.present() {
            let (slip, fast) = (bearings.slip_rate_radps(), bearings.break_radps);
            corners.extend([-slip, slip, -fast, fast]);
        }
        if at_zero {
            corners.push(0.0);
        }
        corners.sort_by(f64::total_cmp);
        let zone = |pair: &[f64]| {
            let (low_radps, high_radps) = (pair[0], pair[1]);
            let sign = if low_radps >= 0.0 {
                1.0
            } else if high_radps <= 0.0 {
                -1.0
            } else {
                0.0
            };
            let least = if sign == 0.0 { 0.0 } else { low_radps.abs().min(high_radps.abs()) };
            let slips = least >= bearings.slip_rate_radps();
            Zone { low_radps, high_radps, sign, slips, fast: least >= bearings.break_radps }
        };
        Self(corners.windows(2).map(zone).collect())
    }

    pub(crate) fn at(&self, index: usize) -> &Zone {
        &self.0[index]
    }

    /// The zone that holds the rate.
    pub(crate) fn find(&self, rate_radps: f64) -> usize {
        self.0.iter().position(|zone| rate_radps <= zone.high_radps).unwrap_or(self.0.len() - 1)
    }
}

impl Zone {
    /// `clamp(w_rel / w_s, -1, 1)`, the formula of the zone continued beyond its ends.
    fn direction(&self, bearings: &Bearings, relative_rate_radps: f64) -> f64 {
        if self.slips { self.sign } else { relative_rate_radps / bearings.slip_rate_radps() }
    }
}

/// `T_f` [N m]: Palmgren's torque under the clamp, and the effects of block `friction`.
pub(crate) fn torque_nm(bearings: &Bearings, laws: &Laws, zone: &Zone, moment: &Moment, y: &Vector) -> f64 {
    let rate = moment.relative_rate_radps(y);
    let drag = laws.drag.torque_nm(rate);
    if !bearings.present() {
        return drag;
    }
    let load = bearings.load_torque_nm(moment.row) * laws.scales.load(moment.row);
    let viscous = bearings.viscous_torque_nm(rate.abs(), zone.fast);
    let excess = laws.stribeck.map_or(0.0, |stribeck| stribeck.level_nm(rate));
    let direction = match laws.presliding {
        Some(presliding) => presliding.ratio(&moment.mode.reversal, zone.sign, y[RELATIVE]),
        None => zone.direction(bearings, rate),
    };
    let drift = laws.drift.map_or(1.0, |drift| drift.factor(moment.time_s));
    (load + viscous + excess) * direction * laws.scales.direction(zone.sign) * drift + drag
}
