//! Functions of one variable as chords over a logarithmic grid, for the step.
//!
//! A segment is found from the value's own binary exponent and leading bits, without a search, a division or a
//! logarithm; its chord needs one product. For `f(x) = x^p` a chord over a sixteenth of an octave is off by at most
//! `|p (p - 1)| / 8 / 16^2` of f: 1.1e-4 for p = 0.33 and p = 2/3.

use crate::number::Number;
use crate::stored::stored;

/// A chord: `offset + slope * x`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Chord<N: Number> {
    pub(crate) offset: N,
    pub(crate) slope: N::Coef,
}

stored!([N: Number] Chord<N> { offset, slope });

impl<N: Number> Chord<N> {
    #[inline(always)]
    pub(crate) fn at(&self, argument: N) -> N {
        self.offset + N::head(self.slope * argument)
    }
}

/// Octaves that a [`PowerTable`] covers; below them it goes on along the lowest chord.
const OCTAVES: i32 = 8;
/// A power of two, so that a mask keeps every index inside.
const CHORDS: usize = 16 * OCTAVES.unsigned_abs() as usize;
const LAST: i32 = 16 * OCTAVES - 1;

/// A rising concave function on the eight octaves below a largest argument.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PowerTable<N: Number> {
    first: i32,
    chords: [Chord<N>; CHORDS],
}

stored!([N: Number] PowerTable<N> { first, chords });

impl<N: Number> PowerTable<N> {
    /// Tabulates `function` up to `largest`, both in SI; arguments and values have the full scales `2^from` and `2^to`.
    pub(crate) fn build(largest: f64, from: i32, to: i32, function: impl Fn(f64) -> f64) -> Self {
        let first = N::quantise(1.001 * largest, from).sixteenth() + 1 - 16 * OCTAVES;
        let mut chords = [Chord::default(); CHORDS];
        for (chord, step) in chords.iter_mut().zip(first..) {
            let left = N::sixteenth_start(step).to_f64(from);
            let right = N::sixteenth_start(step + 1).to_f64(from);
            let slope = if right > left { (function(right) - function(left)) / (right - left) } else { 0.0 };
            *chord = Chord {
                offset: N::quantise(function(left) - slope * left, to),
                slope: N::coef(libm::ldexp(slope, from - to)),
            };
        }
        Self { first, chords }
    }

    /// The function's value. In fixed point `to` must be a full scale in which every slope is below 1.
    #[inline(always)]
    pub(crate) fn at(&self, argument: N) -> N {
        self.chord(segment(self.first, argument)).at(argument)
    }

    /// Segment 0 in steps of [`Number::sixteenth`].
    pub(crate) fn first(&self) -> i32 {
        self.first
    }

    #[inline(always)]
    pub(crate) fn chord(&self, segment: u32) -> &Chord<N> {
        &self.chords[segment as usize & (CHORDS - 1)]
    }
}

/// Segment of an argument in a [`PowerTable`] whose first one is `first`.
#[inline(always)]
pub(crate) fn segment<N: Number>(first: i32, argument: N) -> u32 {
    (argument.sixteenth() - first).clamp(0, LAST).unsigned_abs()
}

/// Square root of a mantissa of two octaves, 32 chords each, to 3.1e-5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SqrtTable<N: Number> {
    chords: [Chord<N>; 64],
}

stored!([N: Number] SqrtTable<N> { chords });

impl<N: Number> SqrtTable<N> {
    /// Of mantissas from [`Number::SQRT_LOWEST`] on, [`Number::SQRT_GAIN`] times the root.
    pub(crate) fn build() -> Self {
        let mut chords = [Chord::default(); 64];
        for (segment, chord) in chords.iter_mut().enumerate() {
            let octave = if segment < 32 { N::SQRT_LOWEST } else { 2.0 * N::SQRT_LOWEST };
            let left = octave * (1.0 + (segment % 32) as f64 / 32.0);
            let right = left + octave / 32.0;
            let slope = N::SQRT_GAIN / (libm::sqrt(left) + libm::sqrt(right));
            let offset = N::SQRT_GAIN * libm::sqrt(left) - slope * left;
            *chord = Chord { offset: N::quantise(offset, 0), slope: N::coef(slope) };
        }
        Self { chords }
    }

    /// The chord of `segment` (its lowest six bits) at `mantissa`.
    #[inline(always)]
    pub(crate) fn chord(&self, segment: u32, mantissa: N) -> N {
        self.segment(segment).at(mantissa)
    }

    #[inline(always)]
    pub(crate) fn segment(&self, segment: u32) -> &Chord<N> {
        &self.chords[(segment & 63) as usize]
    }
}
