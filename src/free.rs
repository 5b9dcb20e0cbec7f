//! The loop while the gyro is off its stops: nine modes, driven by the change of the disturbance torque.
//!
//! ```text
//! x(k+1) = E x(k) + g (u(k) - u(k-1))        theta, phi', phi, T_m = rows of x
//! ```
//!
//! Exact for a torque u held over each period. `phi = (Jo theta' + Bo theta) / H + offset`: the offset is what phi has
//! moved unseen by the gyro, constant between saturations, and not part of the modes.
//!
//! Accuracy: f32 adds `(E - 1) x` to x, fixed point keeps the low half of x through `E x`; either way a slow mode loses
//! nothing of its small change each period.

use crate::build::complex::Complex;
use crate::build::modes::{BLOCKS, Modes, PHYSICAL};
use crate::build::plant::Plant;
use crate::build::poles::ORDER;
use crate::number::Number;
use crate::row::{Row, ScaledRow};
use crate::units::Units;

/// The nine modes' state.
pub(crate) type State<N> = [<N as Number>::Wide; ORDER];

/// A pair of modes: its matrix, what drives it, and its part of two outputs, together because they are used together.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Block<N: Number> {
    pub(crate) transition: [N::Coef; 4],
    pub(crate) drive: [N::Coef; 2],
    pub(crate) gimbal_angle: [N::Coef; 2],
    pub(crate) motor_torque: [N::Coef; 2],
}

/// The ninth mode.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Single<N: Number> {
    pub(crate) transition: N::Coef,
    pub(crate) drive: N::Coef,
    pub(crate) gimbal_angle: N::Coef,
    pub(crate) motor_torque: N::Coef,
}

/// An output at the end of a period: of the modes at its start, and of the torque's change.
type Output<N> = Row<N, { ORDER + 1 }>;

/// The free loop over one period.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Law<N: Number> {
    pub(crate) gimbal_rate: Output<N>,
    pub(crate) blocks: [Block<N>; BLOCKS],
    pub(crate) single: Single<N>,
    /// What the torque's change adds to an output.
    pub(crate) gimbal_angle: N::Coef,
    pub(crate) motor_torque: N::Coef,
    pub(crate) gyro_angle: Output<N>,
    /// Change of phi' over a period for a torque of 1.
    pub(crate) gimbal_rate_gain: Row<N, 1>,
    /// theta' times the period, at one instant.
    pub(crate) gyro_move: ScaledRow<N, ORDER>,
    /// y less `T_d`, then `z_i`, at one instant.
    pub(crate) motor: [ScaledRow<N, ORDER>; 6],
    /// The modes of a physical state.
    pub(crate) entry: [ScaledRow<N, PHYSICAL>; ORDER],
}

/// The modes as signals.
#[derive(Clone, Copy)]
pub(crate) struct Heads<N: Number>([N; ORDER]);

/// The loop at the end of a period.
pub(crate) struct Moved<N: Number> {
    /// theta.
    pub(crate) gyro_angle: N,
    /// phi less the offset.
    pub(crate) gimbal_angle: N::Wide,
    /// `T_m` less the disturbance torque.
    pub(crate) motor_torque: N,
}

impl<N: Number> Law<N> {
    pub(crate) fn build(plant: &Plant, modes: &Modes, units: &Units, period_s: f64) -> Self {
        let (transitions, single) = modes.transition(period_s);
        let drive = modes.drive(period_s);
        let scales = units.modes;
        let drive_coef = |i: usize| N::coef(N::rescaled(drive[i], units.torque - scales[i]));
        let output = |of: &dyn Fn(Complex) -> Complex, to: i32| {
            let after = modes.row(|pole| of(pole) * pole.scale(period_s).exp());
            let gain: f64 = modes.row(of).iter().zip(&drive).map(|(row, drive)| row * drive).sum();
            let mut factors = [gain; ORDER + 1];
            factors[..ORDER].copy_from_slice(&after);
            let mut from = [units.torque; ORDER + 1];
            from[..ORDER].copy_from_slice(&scales);
            (Output::build(factors, from, to), gain)
        };
        let (gimbal_angle, _) = output(&|s| plant.gimbal_angle_of(s), units.gimbal_angle);
        let (motor_torque, _) = output(&|s| plant.motor_torque_of(s), units.motor_torque);
        let last = ORDER - 1;
        let between = |factor: f64, from: usize, to: usize| N::coef(N::rescaled(factor, scales[from] - scales[to]));
        let blocks = core::array::from_fn(|block| {
            let [a, b, c, d] = transitions[block];
            let [i, j] = [2 * block, 2 * block + 1];
            Block {
                transition: [N::decay_coef(a), between(b, j, i), between(c, i, j), N::decay_coef(d)],
                drive: [drive_coef(i), drive_coef(j)],
                gimbal_angle: [gimbal_angle.coefs[i], gimbal_angle.coefs[j]],
                motor_torque: [motor_torque.coefs[i], motor_torque.coefs[j]],
            }
        });
        let single = Single {
            transition: N::decay_coef(single),
            drive: drive_coef(last),
            gimbal_angle: gimbal_angle.coefs[last],
            motor_torque: motor_torque.coefs[last],
        };
        let (gimbal_rate, rate_gain) = output(&|s| plant.gimbal_rate_of(s), units.gimbal_rate);
        let instant = |of: &dyn Fn(Complex) -> Complex, to| ScaledRow::build(modes.row(of), scales, to);
        let physical = units.physical();
        let entry = modes.entry();
        Self {
            blocks,
            single,
            gimbal_angle: gimbal_angle.coefs[ORDER],
            motor_torque: motor_torque.coefs[ORDER],
            gyro_angle: output(&|_| Complex::ONE, units.gyro_angle).0,
            gimbal_rate,
            gyro_move: instant(&|s| s.scale(period_s), units.gyro_angle),
            motor: core::array::from_fn(|i| match i {
                0 => instant(&|s| Complex::real(plant.integrator_gain) / s, units.motor_torque),
                _ => instant(&|s| plant.lag_state_of(s, i - 1), units.lags[i - 1]),
            }),
            entry: core::array::from_fn(|i| {
                ScaledRow::build(core::array::from_fn(|j| entry[j][i]), physical, scales[i])
            }),
            gimbal_rate_gain: Row::build([rate_gain], [units.torque], units.gimbal_rate),
        }
    }

    /// phi' at the end of the period if the torque changes by `torque_change`.
    #[inline(always)]
    pub(crate) fn gimbal_rate(&self, heads: &Heads<N>, torque_change: N) -> N {
        self.gimbal_rate.at(&heads.with(torque_change))
    }

    /// Advances the modes by one period.
    #[inline(always)]
    pub(crate) fn advance(&self, modes: &mut State<N>, heads: &Heads<N>, torque_change: N) -> Moved<N> {
        let mut gimbal_angle = self.gimbal_angle * torque_change;
        let mut motor_torque = self.motor_torque * torque_change;
        let mut theta = N::Wide::default();
        for (block, (x, head)) in self.blocks.iter().zip(modes.chunks_exact_mut(2).zip(heads.0.chunks_exact(2))) {
            let [a, b, c, d] = block.transition;
            x[0] = N::low(x[0]) + a * head[0] + b * head[1] + block.drive[0] * torque_change;
            x[1] = N::low(x[1]) + c * head[0] + d * head[1] + block.drive[1] * torque_change;
            theta = theta + x[0] + x[1];
            gimbal_angle = gimbal_angle + block.gimbal_angle[0] * head[0] + block.gimbal_angle[1] * head[1];
            motor_torque = motor_torque + block.motor_torque[0] * head[0] + block.motor_torque[1] * head[1];
        }
        let (x, head) = (&mut modes[ORDER - 1], heads.0[ORDER - 1]);
        *x = N::low(*x) + self.single.transition * head + self.single.drive * torque_change;
        Moved {
            // The modes add up to theta; in fixed point they have different full scales.
            gyro_angle: if N::HAS_SCALES {
                self.gyro_angle.at(&heads.with(torque_change))
            } else {
                N::head(theta + *x)
            },
            gimbal_angle: gimbal_angle + self.single.gimbal_angle * head,
            motor_torque: N::head(motor_torque + self.single.motor_torque * head),
        }
    }
}

impl<N: Number> Heads<N> {
    #[inline(always)]
    pub(crate) fn of(modes: &State<N>) -> Self {
        Self(modes.map(N::head))
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
