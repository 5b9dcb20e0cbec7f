//! Estimator and monitor, on the model's own theta and motor torque with a pick-off's noise.

use crate::tally::Tally;
use core::hint::black_box;
use gimbal_firmware::cases::{Case, FLIGHT, STOPS};
use gimbal_firmware::counter::Counter;
use gimbal_firmware::noise::Noise;
use gimbal_servo::{Number, estimator, monitor};

/// Flight, and stop to stop without the torque that the model is told of: the estimator must find it.
pub(crate) const CASES: [Case; 2] = [FLIGHT, Case { steps: 5_000, ..STOPS }];

/// Rows until the filter's steady gains hold; they are counted, in a row of their own.
const SETTLING: u32 = 200;

#[inline(never)]
pub(crate) fn count<N: Number>(counter: &mut Counter, case: &Case, number: &str) -> Result<(), &'static str> {
    let config = (case.config)();
    let built = config.build::<N>();
    let Ok(axis) = &built else { return Err("the law cannot be built") };
    let built = estimator::Config::default().build::<N>(&config);
    let Ok(law) = &built else { return Err("the estimator cannot be built") };
    let Ok(test) = monitor::Config::default().build::<N>(&config, law.gyro_exponent()) else {
        return Err("the monitor cannot be built");
    };
    let (mut model, mut state, mut test_state) = (axis.start(), law.start(), test.start());
    let mut noise = Noise::new();
    let [mut settling, mut steady, mut monitored] = [Tally::EMPTY; 3];
    for k in 0..case.steps {
        let modelled = axis.step(&mut model, case.input(axis, k));
        let si = axis.units().output(&modelled);
        let measured = black_box(
            law.measured(Some(si.gyro_angle_rad + noise.next(2e-6)), Some(si.motor_torque_nm + noise.next(1e-5))),
        );
        let counted = counter.count(|| {
            black_box(law.step(&mut state, &measured, axis, &model, modelled.faults));
        });
        if k < SETTLING {
            settling.add(counted);
        } else {
            steady.add(counted);
        }
        monitored.add(counter.count(|| {
            black_box(test.step(&mut test_state, measured.gyro_angle_rad, &model));
        }));
    }
    let [settled, unsettled, monitor] = if case.name == FLIGHT.name {
        ["estimator", "estimator-settling", "monitor"]
    } else {
        ["estimator-stops", "estimator-stops-settling", "monitor-stops"]
    };
    steady.print("cost", settled, number);
    settling.print("cost", unsettled, number);
    monitored.print("cost", monitor, number);
    Ok(())
}
