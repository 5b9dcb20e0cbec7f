//! Size of the friction torque in the step: Palmgren's formulas on tables.

use crate::Config;
use crate::number::Number;
use crate::row::Row;
use crate::table::{PowerTable, SqrtTable};
use crate::units::Units;

/// Size of the friction torque of all bearings, for one row of inputs.
///
/// (6.1) and (6.2) cross where one ends and the other begins, so that their larger one is the load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    pub(crate) largest_radial: N,
    /// `F_s` of `|a_z|` and `A_r`, less its part from the preload.
    pub(crate) static_load: Row<N, 2>,
    pub(crate) static_preload: N,
    /// (6.1)'s load, likewise.
    pub(crate) axial_load: Row<N, 2>,
    pub(crate) axial_preload: N,
    /// (6.2)'s load of `A_r`.
    pub(crate) radial_load: Row<N, 1>,
    /// From the product of power and load to the full scale of torques.
    pub(crate) shift: u32,
    pub(crate) viscous_break: N,
    pub(crate) viscous_low: N,
}

/// Its tables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tables<N: Number> {
    pub(crate) sqrt: SqrtTable<N>,
    /// `c n F_s^0.33`, n the number of bearings.
    pub(crate) power: PowerTable<N>,
    pub(crate) viscous_high: PowerTable<N>,
}

impl<N: Number> Tables<N> {
    /// Square roots.
    pub(crate) fn sqrt(&self) -> &SqrtTable<N> {
        &self.sqrt
    }
}

/// The friction level and whether an input lay beyond the tables.
pub(crate) struct Level<N> {
    pub(crate) torque: N,
    pub(crate) table_end: bool,
}

impl<N: Number> Law<N> {
    pub(crate) fn build(config: &Config, units: &Units) -> (Self, Tables<N>) {
        let bearing = &config.bearing;
        let count = f64::from(bearing.count);
        let range = &config.range;
        let (preload, _) = bearing.loads_n(0.0, 0.0);
        let (most_axial, most_radial) = bearing.loads_n(range.radial_accel_mps2, range.axial_accel_mps2);
        let share = (most_axial - preload) / range.axial_accel_mps2;
        let (fa, fr) = (bearing.static_axial_factor, bearing.static_radial_factor);
        let (ta, tr) = (bearing.torque_axial_factor, bearing.torque_radial_factor);
        let largest_static = fa * most_axial + fr * most_radial;
        let largest_load = (ta * most_axial).max(most_radial);

        // Each term has room for the full scale of the acceleration, which may be far above the axial one's range.
        let accel = [units.accel; 2];
        let scale =
            |largest: f64, factors: [f64; 2]| N::exponent(2.0 * largest).max(Row::<N, 2>::exponent(factors, accel));
        let static_scale = scale(largest_static, [fa * share, fr * share]);
        let load_scale = scale(largest_load, [ta * share, share.max(tr * share)]);
        let power = |load: f64| count * bearing.load_torque_nm_per_n * libm::pow(load, bearing.load_exponent);
        let smallest_static = fa * preload;
        let steepest = bearing.load_exponent * power(smallest_static) / smallest_static;
        let power_scale =
            N::exponent(power(largest_static).max(N::rescaled(steepest, static_scale))).max(units.torque - load_scale);

        let viscous = |rate: f64| count * bearing.viscous_torque_nm(rate);
        let viscous_break = bearing.viscous_break_radps();
        let tables = Tables {
            sqrt: SqrtTable::build(),
            power: PowerTable::build(largest_static, static_scale, power_scale, power),
            viscous_high: PowerTable::build(range.rate_radps, units.rate, units.torque, |rate| {
                // The branch above the break, also where a grid cell begins below it.
                viscous(viscous_break * (1.0 + 1e-12)) * libm::pow(rate / viscous_break, 2.0 / 3.0)
            }),
        };
        let law = Self {
            largest_radial: N::quantise(range.radial_accel_mps2, units.accel),
            static_load: Row::build([fa * share, fr * share], accel, static_scale),
            static_preload: N::quantise(smallest_static, static_scale),
            axial_load: Row::build([ta * share, -tr * share], accel, load_scale),
            axial_preload: N::quantise(ta * preload, load_scale),
            radial_load: Row::build([share], [units.accel], load_scale),
            shift: (power_scale + load_scale - units.torque).unsigned_abs(),
            viscous_break: N::quantise(viscous_break.min(range.rate_radps), units.rate),
            viscous_low: N::quantise(viscous(0.0), units.torque),
        };
        (law, tables)
    }

    /// Friction level under the specific force at the relative rate `rate`.
    #[inline(always)]
    pub(crate) fn at(&self, tables: &Tables<N>, [accel_x, accel_y, accel_z]: [N; 3], rate: N) -> Level<N> {
        let radial = accel_x.hypot(accel_y, &tables.sqrt);
        let table_end = radial > self.largest_radial;
        let radial = radial.least(self.largest_radial);
        let axial = accel_z.abs();
        let power = tables.power.at(self.static_load(axial, radial));
        let load = self.load(axial, radial);
        let speed = rate.abs();
        let viscous = if speed > self.viscous_break { tables.viscous_high.at(speed) } else { self.viscous_low };
        Level { torque: power.times(load).shift_up(self.shift) + viscous, table_end }
    }

    /// `F_s`.
    #[inline(always)]
    pub(crate) fn static_load(&self, axial: N, radial: N) -> N {
        self.static_preload + self.static_load.at(&[axial, radial])
    }

    /// What the power of `F_s` is multiplied by.
    #[inline(always)]
    pub(crate) fn load(&self, axial: N, radial: N) -> N {
        (self.axial_preload + self.axial_load.at(&[axial, radial])).most(self.radial_load.at(&[radial]))
    }
}
