//! What is tried of every effect: shapes over the sizes that a motion can tell.

use std::f64::consts::TAU;

use super::library::Shape;
use super::memory::Yields;
use super::motion::{LEAST_WAVES, Motion};

/// Travel from which on one wave a turn is tried, however few of them the others must have.
const GRAVITY_SHOWS_RAD: f64 = 1.5;

/// Everything that is tried without a search for numbers of waves, modes and plays.
pub(super) fn shapes(m: &Motion) -> Vec<Shape> {
    let mut shapes = vec![
        Shape::Inertia,
        Shape::Viscous,
        Shape::Coulomb,
        Shape::Scale,
        Shape::Constant,
        Shape::Asymmetry,
        Shape::DragAsymmetry,
        Shape::Quadratic,
        Shape::LoadDependence,
        Shape::InertialLoad,
        Shape::FrictionTaper,
        Shape::Spring,
        Shape::DeadZone,
        Shape::TorqueCurve,
        Shape::Lag,
        Shape::Flexible,
    ];
    for share in [0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32] {
        let rate = share * m.fastest;
        if rate > m.quiet {
            shapes.extend([1.0, 2.0].map(|exponent| Shape::Stribeck { rate, exponent }));
        }
    }
    for exponent in [0.5, 0.667] {
        shapes.push(Shape::ViscousCurve { exponent });
    }
    for share in [3e-4, 1e-3, 3e-3, 1e-2, 3e-2] {
        let length = share * m.travel;
        if length > 4.0 * m.position_noise {
            shapes.extend(Yields::ALL.map(|yields| Shape::Presliding { displacement: length, yields }));
        }
    }
    // gravity on an arm has one wave a turn; on a shorter way it is a spring
    if m.rotary && (GRAVITY_SHOWS_RAD..LEAST_WAVES * TAU).contains(&m.travel) {
        shapes.push(Shape::Ripple { wave_number: 1.0 });
    }
    for share in [0.03, 0.055, 0.1, 0.18, 0.3] {
        shapes.extend(Yields::ALL.map(|yields| Shape::Hysteresis { width: share * m.travel, yields }));
    }
    for share in [0.05, 0.15, 0.4, 1.0] {
        let time_s = share * m.length_s();
        shapes.extend([Shape::FrictionDrift { time_s }, Shape::ViscousDrift { time_s }, Shape::BiasDrift { time_s }]);
    }
    for channel in 0..m.auxiliary.len() {
        shapes.extend([Shape::Load { channel }, Shape::LoadFriction { channel }, Shape::LoadGain { channel }]);
    }
    if m.stands {
        // without slip nothing that hangs on rate or acceleration can be told
        shapes.retain(|shape| {
            matches!(
                shape,
                Shape::Coulomb
                    | Shape::Constant
                    | Shape::Spring
                    | Shape::Hysteresis { .. }
                    | Shape::BiasDrift { .. }
                    | Shape::Presliding { .. }
                    | Shape::FrictionTaper
                    | Shape::Load { .. }
            )
        });
    }
    shapes
}
