//! Size of the friction torque in the step: Palmgren's formulas on tables.

use crate::Config;
use crate::faults::Faults;
use crate::number::Number;
use crate::row::Row;
use crate::stored::stored;
use crate::table::{PowerTable, SqrtTable};
use crate::units::Units;

/// Size of the friction torque of all bearings, for one row of inputs.
///
/// (6.1) and (6.2) cross where one ends and the other begins, so that their larger one is the load. Loads are counted as
/// the radial acceleration that makes them: (6.2)'s is `A_r` itself.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Law<N: Number> {
    /// Largest radial acceleration, as bits: values without a sign are in the order of theirs.
    pub(crate) largest_radial: u32,
    /// `F_s` of `|a_z|` and `A_r`, less its part from the preload.
    pub(crate) static_load: Row<N, 2>,
    /// (6.1)'s load, likewise.
    pub(crate) axial_load: Row<N, 2>,
    pub(crate) static_preload: N::Wide,
    pub(crate) axial_preload: N::Wide,
    /// `A_r` to the full scale of loads.
    pub(crate) load_shift: u32,
    /// From the product of power and load to the full scale of torques.
    pub(crate) shift: u32,
    pub(crate) viscous_break: u32,
    pub(crate) viscous_low: N,
}

stored!([N: Number] Law<N> {
    largest_radial, static_load, axial_load, static_preload, axial_preload, load_shift, shift, viscous_break,
    viscous_low,
});

/// Its tables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tables<N: Number> {
    pub(crate) sqrt: SqrtTable<N>,
    /// `c n F_s^0.33`, n the number of bearings.
    pub(crate) power: PowerTable<N>,
    pub(crate) viscous_high: PowerTable<N>,
}

stored!([N: Number] Tables<N> { sqrt, power, viscous_high });

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
        let radial_share = most_radial / range.radial_accel_mps2;
        let largest_load = (ta * most_axial).max(most_radial) / radial_share;

        // Each term has room for the full scale of the acceleration, which may be far above the axial one's range.
        let accel = [units.accel; 2];
        let scale =
            |largest: f64, factors: [f64; 2]| N::exponent(2.0 * largest).max(Row::<N, 2>::exponent(factors, accel));
        let static_scale = scale(largest_static, [fa * share, fr * share]);
        let axial_load = [ta * share / radial_share, -tr * share / radial_share];
        let load_scale = scale(largest_load, axial_load).max(units.accel);
        let power =
            |load: f64| count * bearing.load_torque_nm_per_n * libm::pow(load, bearing.load_exponent) * radial_share;
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
            largest_radial: N::quantise(range.radial_accel_mps2, units.accel).to_bits(),
            static_load: Row::build([fa * share, fr * share], accel, static_scale),
            axial_load: Row::build(axial_load, accel, load_scale),
            static_preload: N::quantise(smallest_static, static_scale).widen(),
            axial_preload: N::quantise(ta * preload / radial_share, load_scale).widen(),
            load_shift: (load_scale - units.accel).unsigned_abs(),
            shift: (power_scale + load_scale - units.torque).unsigned_abs(),
            viscous_break: N::quantise(viscous_break.min(range.rate_radps), units.rate).limit(),
            viscous_low: N::quantise(viscous(0.0), units.torque),
        };
        (law, tables)
    }

    /// Friction level under the specific force at the relative rate `rate`; it sets the bit if it lies beyond the tables.
    #[inline(always)]
    pub(crate) fn at(&self, tables: &Tables<N>, accel: [N; 3], rate: N, faults: &mut Faults) -> N {
        let [accel_x, accel_y, accel_z] = accel;
        let mut radial = accel_x.hypot(accel_y, &tables.sqrt);
        if self.ends_before(radial) {
            let end;
            (radial, end) = self.end_of_tables();
            *faults |= end;
        }
        let axial = accel_z.abs();
        let power = tables.power.at(self.static_load(axial, radial));
        let load = self.load(axial, radial);
        let viscous =
            if rate.beyond(self.viscous_break) { tables.viscous_high.at(rate.abs()) } else { self.viscous_low };
        power.times(load).times_power(self.shift) + viscous
    }

    /// Whether a radial acceleration lies beyond the tables.
    #[inline(always)]
    pub(crate) fn ends_before(&self, radial: N) -> bool {
        radial.to_bits() > self.largest_radial
    }

    /// The largest radial acceleration and its bit: by a branch, for selected they would be on the straight path.
    #[cold]
    #[inline(never)]
    fn end_of_tables(&self) -> (N, Faults) {
        core::hint::black_box((N::from_bits(self.largest_radial), Faults::TABLE_END))
    }

    /// `F_s`.
    #[inline(always)]
    pub(crate) fn static_load(&self, axial: N, radial: N) -> N {
        self.static_load.above(self.static_preload, &[axial, radial])
    }

    /// What the power of `F_s` is multiplied by.
    #[inline(always)]
    pub(crate) fn load(&self, axial: N, radial: N) -> N {
        let axial_load = self.axial_load.above(self.axial_preload, &[axial, radial]);
        axial_load.most(radial.shift_down(self.load_shift))
    }
}
