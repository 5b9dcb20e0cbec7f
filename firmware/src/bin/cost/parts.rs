//! Blocks of the step by themselves, each as a function of its own: with the call, and with what it loads from memory,
//! which the step keeps in registers from one block to the next. Their sum is therefore above the step.

use crate::tally::Tally;
use core::hint::black_box;
use gimbal_firmware::cases::FLIGHT;
use gimbal_firmware::counter::Counter;
use gimbal_servo::Number;
use gimbal_servo::parts::Modes;

/// Two seconds: the blocks have no long path that the flight would reach later.
const STEPS: u32 = 2_000;

#[inline(never)]
pub(crate) fn count<N: Number>(counter: &mut Counter, number: &str) -> Result<(), &'static str> {
    let built = (FLIGHT.config)().build::<N>();
    let Ok(law) = &built else { return Err("the law cannot be built") };
    let (mut state, mut modes) = (law.start(), Modes::default());
    let [mut linear, mut guard, mut friction, mut level, mut root] = [Tally::EMPTY; 5];
    let mut admitted = FLIGHT.input(law, 0);
    let mut last = law.step(&mut state, FLIGHT.input(law, 0));
    for k in 1..STEPS {
        let row = black_box(FLIGHT.input(law, k));
        guard.add(counter.count(|| {
            black_box(law.part_guard(&mut admitted, &row));
        }));
        let now = black_box(law.step(&mut state, row));
        let (accel_x, accel_y) = black_box((row.accel_x_mps2, row.accel_y_mps2));
        root.add(counter.count(|| {
            black_box(law.part_root(accel_x, accel_y));
        }));
        let mut size = N::default();
        level.add(counter.count(|| size = law.part_level(&row, now.relative_rate_radps)));
        let size = black_box(size);
        friction.add(counter.count(|| {
            black_box(law.part_friction(&last, &now, size));
        }));
        let change = black_box(now.disturbance_torque_nm - last.disturbance_torque_nm);
        linear.add(counter.count(|| {
            black_box(law.part_linear(&mut modes, change));
        }));
        last = now;
    }
    linear.print("cost", "linear", number);
    guard.print("cost", "input-guard", number);
    level.print("cost", "friction-level", number);
    root.print("cost", "friction-level-root", number);
    friction.print("cost", "friction-solution", number);
    Ok(())
}
