//! The loop while the gyro is off its stops: nine modes, driven by the change of the disturbance torque.
//!
//! ```text
//! x(k+1) = E x(k) + g (u(k) - u(k-1))        theta, phi', phi = rows of x
//! ```
//!
//! Exact for a torque held over each period; u is twice that torque, the sum of both ends. `phi = (Jo theta' + Bo theta) / H + offset`: the offset is what phi has
//! moved unseen by the gyro, constant between saturations, and not part of the modes.
//!
//! Accuracy: f32 adds `(E - 1) x` to x, fixed point keeps the low half of x through `E x`; either way a slow mode loses
//! nothing of its small change each period.

use crate::build::complex::Complex;
use crate::build::modes::{BLOCKS, Modes, PHYSICAL};
use crate::build::plant::Plant;
use crate::build::poles::ORDER;
use crate::number::Number;
use crate::row::{Row, ScaledRow, sums};
use crate::stored::stored;
use crate::units::Units;

/// The nine modes' state.
pub(crate) type State<N> = [<N as Number>::Wide; ORDER];

/// A pair of modes: its matrix, and what drives it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Block<N: Number> {
    pub(crate) transition: [N::Coef; 4],
    pub(crate) drive: [N::Coef; 2],
}

stored!([N: Number] Block<N> { transition, drive });

/// The ninth mode.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Single<N: Number> {
    pub(crate) transition: N::Coef,
    pub(crate) drive: N::Coef,
}

stored!([N: Number] Single<N> { transition, drive });

/// An output at the end of a period: of the modes at its start, and of the torque's change.
type Output<N> = Row<N, { ORDER + 1 }>;

/// The free loop over one period.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Law<N: Number> {
    pub(crate) gimbal_rate: [N::Coef; ORDER],
    pub(crate) gimbal_angle: [N::Coef; ORDER],
    /// What the torque's change adds to phi' and to phi.
    pub(crate) gimbal_rate_gain: N::Coef,
    pub(crate) gimbal_angle_gain: N::Coef,
    pub(crate) blocks: [Block<N>; BLOCKS],
    pub(crate) single: Single<N>,
    pub(crate) gyro_angle: Output<N>,
}

stored!([N: Number] Law<N> {
    gimbal_rate, gimbal_angle, gimbal_rate_gain, gimbal_angle_gain, blocks, single, gyro_angle,
});

/// The modes and the physical state at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Instant<N: Number> {
    /// `T_m` less `T_d`.
    pub(crate) motor_torque: ScaledRow<N, ORDER>,
    /// theta' times the period, of phi less its offset and theta: `Jo theta' = H phi - Bo theta`.
    pub(crate) gyro_move: ScaledRow<N, 2>,
    /// y less `T_d`, then `z_i`.
    pub(crate) motor: [ScaledRow<N, ORDER>; 6],
    /// The modes of a physical state.
    pub(crate) entry: [ScaledRow<N, PHYSICAL>; ORDER],
}

stored!([N: Number] Instant<N> { motor_torque, gyro_move, motor, entry });

/// The modes as signals.
#[derive(Clone, Copy)]
pub(crate) struct Heads<N: Number>([N; ORDER]);

impl<N: Number> Law<N> {
    pub(crate) fn build(plant: &Plant, modes: &Modes, units: &Units, period_s: f64) -> Self {
        let modes = &coordinates::<N>(modes, period_s);
        let (transitions, single) = modes.transition(period_s);
        let drive = modes.drive(period_s).map(|factor| 0.5 * factor);
        let scales = units.modes;
        let drive_coef = |i: usize| N::coef(N::rescaled(drive[i], units.torque - scales[i]));
        let output = |of: &dyn Fn(Complex) -> Complex, to: i32| {
            let after = modes.row(|pole| of(pole) * pole.scale(period_s).exp());
            let gain: f64 = modes.row(of).iter().zip(&drive).map(|(row, drive)| row * drive).sum();
            let mut factors = [gain; ORDER + 1];
            factors[..ORDER].copy_from_slice(&after);
            let mut from = [units.torque; ORDER + 1];
            from[..ORDER].copy_from_slice(&scales);
            Output::build(factors, from, to)
        };
        let split = |row: Output<N>| {
            let [a, b, c, d, e, f, g, h, i, gain] = row.coefs;
            ([a, b, c, d, e, f, g, h, i], gain)
        };
        let (gimbal_angle, gimbal_angle_gain) = split(output(&|s| plant.gimbal_angle_of(s), units.gimbal_angle));
        let last = ORDER - 1;
        let between = |factor: f64, from: usize, to: usize| N::coef(N::rescaled(factor, scales[from] - scales[to]));
        let blocks = core::array::from_fn(|block| {
            let [a, b, c, d] = transitions[block];
            let [i, j] = [2 * block, 2 * block + 1];
            Block {
                transition: [N::decay_coef(a), between(b, j, i), between(c, i, j), N::decay_coef(d)],
                drive: [drive_coef(i), drive_coef(j)],
            }
        });
        let single = Single { transition: N::decay_coef(single), drive: drive_coef(last) };
        let (gimbal_rate, gimbal_rate_gain) = split(output(&|s| plant.gimbal_rate_of(s), units.gimbal_rate));
        Self {
            blocks,
            single,
            gyro_angle: output(&|_| Complex::ONE, units.gyro_angle),
            gimbal_rate,
            gimbal_angle,
            gimbal_rate_gain,
            gimbal_angle_gain,
        }
    }

    /// What the modes make of phi' and of phi by the end of the period, the torque's change left out.
    ///
    /// Worked out before friction is solved: then a mode's new value can take its old one's place.
    #[inline(always)]
    pub(crate) fn quiet(&self, heads: &Heads<N>) -> (N::Wide, N::Wide) {
        let [a, b, c, d, e, f, g, h, i] = heads.0;
        let of = |row: &[N::Coef; ORDER]| {
            row[0] * a
                + row[1] * b
                + row[2] * c
                + row[3] * d
                + row[4] * e
                + row[5] * f
                + row[6] * g
                + row[7] * h
                + row[8] * i
        };
        (of(&self.gimbal_rate), of(&self.gimbal_angle))
    }

    /// Advances the modes by one period. Gives theta.
    ///
    /// In fixed point as a function of its own: among all else, its sums of two words do not keep to the registers.
    #[inline(always)]
    pub(crate) fn advance(&self, modes: &mut State<N>, heads: &Heads<N>, torque_change: N) -> N {
        if N::HAS_SCALES {
            self.advance_apart(modes, torque_change)
        } else {
            self.advance_here(modes, heads, torque_change)
        }
    }

    #[inline(never)]
    fn advance_apart(&self, modes: &mut State<N>, torque_change: N) -> N {
        let [pairs @ .., last] = modes;
        let head = N::head(*last);
        *last = N::kept(*last, head) + self.single.transition * head + self.single.drive * torque_change;
        let [.., row, gain] = self.gyro_angle.coefs;
        let mut theta = row * head + gain * torque_change;
        let blocks = core::hint::black_box(self.blocks.as_slice());
        for ((block, x), row) in blocks.iter().zip(pairs.chunks_exact_mut(2)).zip(self.gyro_angle.coefs.chunks_exact(2))
        {
            let [a, b, c, d] = block.transition;
            let head = [N::head(x[0]), N::head(x[1])];
            theta = theta + row[0] * head[0] + row[1] * head[1];
            x[0] = N::kept(x[0], head[0]) + a * head[0] + b * head[1] + block.drive[0] * torque_change;
            x[1] = N::kept(x[1], head[1]) + d * head[1] + c * head[0] + block.drive[1] * torque_change;
        }
        N::head(theta)
    }

    #[inline(always)]
    fn advance_here(&self, modes: &mut State<N>, heads: &Heads<N>, torque_change: N) -> N {
        let heads = Heads(N::as_words(heads.0));
        let (x, head) = (&mut modes[ORDER - 1], heads.0[ORDER - 1]);
        *x = N::kept(*x, head) + self.single.transition * head + self.single.drive * torque_change;
        let mut theta = *x;
        for (block, (x, head)) in self.blocks.iter().zip(modes.chunks_exact_mut(2).zip(heads.0.chunks_exact(2))) {
            let [a, b, c, d] = block.transition;
            if N::HAS_SCALES {
                x[0] = N::kept(x[0], head[0]) + a * head[0] + b * head[1] + block.drive[0] * torque_change;
            } else {
                // In steps the second coordinate is the first one's change, and the first ones add up to theta.
                x[0] = head[0].widen() + head[1].widen() + block.drive[0] * torque_change;
                theta = theta + x[0];
            }
            x[1] = N::kept(x[1], head[1]) + d * head[1] + c * head[0] + block.drive[1] * torque_change;
        }
        if N::HAS_SCALES { self.gyro_angle.at(&heads.with(torque_change)) } else { N::head(theta) }
    }
}

/// The modes in the coordinates that the law's state has.
fn coordinates<N: Number>(modes: &Modes, period_s: f64) -> Modes {
    if N::HAS_SCALES { *modes } else { modes.in_steps(period_s) }
}

impl<N: Number> Instant<N> {
    pub(crate) fn build(plant: &Plant, modes: &Modes, units: &Units, period_s: f64) -> Self {
        let modes = &coordinates::<N>(modes, period_s);
        let instant = |of: &dyn Fn(Complex) -> Complex, to| ScaledRow::build(modes.row(of), units.modes, to);
        let physical = units.physical();
        let entry = modes.entry();
        Self {
            motor_torque: instant(&|s| plant.motor_torque_of(s), units.motor_torque),
            gyro_move: ScaledRow::build(
                [plant.momentum, -plant.damping].map(|factor| factor / plant.float_inertia * period_s),
                [units.gimbal_angle, units.gyro_angle],
                units.gyro_angle,
            ),
            motor: core::array::from_fn(|i| match i {
                0 => instant(&|s| Complex::real(plant.integrator_gain) / s, units.motor_torque),
                _ => instant(&|s| plant.lag_state_of(s, i - 1), units.lags[i - 1]),
            }),
            entry: core::array::from_fn(|i| {
                ScaledRow::build(core::array::from_fn(|j| entry[j][i]), physical, units.modes[i])
            }),
        }
    }
}

impl<N: Number> Instant<N> {
    /// y less `T_d`, then `z_i`.
    pub(crate) fn motor(&self, heads: &Heads<N>) -> [N; 6] {
        let mut motor = [N::Wide::default(); 6];
        sums(&self.motor, heads.modes(), &mut motor);
        core::array::from_fn(|i| N::narrow_shifted(motor[i], self.motor[i].shift))
    }

    /// The modes of a physical state.
    pub(crate) fn enter(&self, modes: &mut State<N>, physical: &[N; PHYSICAL]) {
        sums(&self.entry, physical, modes);
        for (mode, row) in modes.iter_mut().zip(&self.entry) {
            *mode = N::widen_shifted(*mode, row.shift);
        }
    }
}

impl<N: Number> Heads<N> {
    #[inline(always)]
    pub(crate) fn of(modes: &State<N>) -> Self {
        let [a, b, c, d, e, f, g, h, i] = *modes;
        let head = N::head;
        Self([head(a), head(b), head(c), head(d), head(e), head(f), head(g), head(h), head(i)])
    }

    /// The modes at the instant itself.
    #[inline(always)]
    pub(crate) fn modes(&self) -> &[N; ORDER] {
        &self.0
    }

    #[inline(always)]
    fn with(&self, torque_change: N) -> [N; ORDER + 1] {
        let [a, b, c, d, e, f, g, h, i] = self.0;
        [a, b, c, d, e, f, g, h, i, torque_change]
    }
}
