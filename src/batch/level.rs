//! Size of the friction torque of all lanes: [`crate::bearing::level`] with each lane's chords at hand.
//!
//! A lane keeps the three chords that it read last. As long as its arguments stay within their segments, a few percent
//! wide, no table is looked at.

use super::Rows;
use super::coefs::Coefs;
use super::memory::Memory;
use crate::law::Law;
use crate::number::Number;
use crate::number::float::Square;
use crate::table::{Chord, segment};

/// A chord of each lane.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
struct Chords<const L: usize> {
    segment: [u32; L],
    offset: [f32; L],
    slope: [f32; L],
}

/// The chords that were read last, and arguments on their way.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct Levels<const L: usize> {
    sqrt: Chords<L>,
    power: Chords<L>,
    viscous: Chords<L>,
    mantissa: [f32; L],
    scale: [f32; L],
    static_load: [f32; L],
    load: [f32; L],
    speed: [f32; L],
    pub(super) table_end: [u32; L],
}

impl<const L: usize> Chords<L> {
    fn new() -> Self {
        Self { segment: [u32::MAX; L], offset: [0.0; L], slope: [0.0; L] }
    }

    #[inline(always)]
    fn at(&self, lane: usize, argument: f32) -> f32 {
        Chord { offset: self.offset[lane], slope: self.slope[lane] }.at(argument)
    }

    /// Reads the chords anew where segments have changed.
    #[inline(always)]
    fn turn_to(&mut self, segments: &[u32; L], change: u32, chord: impl Fn(usize, u32) -> Chord<f32>) {
        if change != 0 {
            for lane in 0..L {
                let Chord { offset, slope } = chord(lane, segments[lane]);
                self.offset[lane] = offset;
                self.slope[lane] = slope;
            }
            self.segment = *segments;
        }
    }
}

impl<const L: usize> Levels<L> {
    pub(super) fn new() -> Self {
        let zero = [0.0; L];
        Self {
            sqrt: Chords::new(),
            power: Chords::new(),
            viscous: Chords::new(),
            mantissa: zero,
            scale: zero,
            static_load: zero,
            load: zero,
            speed: zero,
            table_end: [0; L],
        }
    }

    /// The friction levels at the rows, into `next`.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        coefs: &Coefs<L>,
        laws: &[&Law<f32>; L],
        last: &Memory<L>,
        rows: &Rows<L>,
        levels: &mut [f32; L],
    ) {
        let mut segments = [0; L];
        let mut change = 0;
        for lane in 0..L {
            let square = Square::of_sum(rows.accel_x_mps2[lane], rows.accel_y_mps2[lane]);
            segments[lane] = square.segment & 63;
            change |= segments[lane] ^ self.sqrt.segment[lane];
            self.mantissa[lane] = square.mantissa;
            self.scale[lane] = square.power;
        }
        self.sqrt.turn_to(&segments, change, |lane, segment| *laws[lane].tables.sqrt.segment(segment));
        let mut viscous_segments = [0; L];
        let (mut change, mut viscous_change) = (0, 0);
        for lane in 0..L {
            let law = coefs.level(lane);
            let radial = self.sqrt.at(lane, self.mantissa[lane]) * self.scale[lane];
            self.table_end[lane] = u32::from(law.ends_before(radial));
            let radial = radial.least(f32::from_bits(law.largest_radial));
            let axial = rows.accel_z_mps2[lane].abs();
            self.static_load[lane] = law.static_load(axial, radial);
            self.load[lane] = law.load(axial, radial);
            segments[lane] = segment(coefs.first_power[lane], self.static_load[lane]);
            change |= segments[lane] ^ self.power.segment[lane];
            self.speed[lane] = (rows.vehicle_rate_radps[lane] - last.sensed_rate[lane]).abs();
            let viscous = segment(coefs.first_viscous[lane], self.speed[lane]);
            let is_high = self.speed[lane].beyond(law.viscous_break);
            viscous_segments[lane] = if is_high { viscous } else { self.viscous.segment[lane] };
            viscous_change |= viscous_segments[lane] ^ self.viscous.segment[lane];
        }
        self.power.turn_to(&segments, change, |lane, segment| *laws[lane].tables.power.chord(segment));
        self.viscous
            .turn_to(&viscous_segments, viscous_change, |lane, segment| *laws[lane].tables.viscous_high.chord(segment));
        for lane in 0..L {
            let law = coefs.level(lane);
            let high = self.viscous.at(lane, self.speed[lane]);
            let viscous = if self.speed[lane].beyond(law.viscous_break) { high } else { law.viscous_low };
            levels[lane] = self.power.at(lane, self.static_load[lane]).times(self.load[lane]) + viscous;
        }
    }
}
