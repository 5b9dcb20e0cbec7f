//! The whole step: what has to be done in every period. The outputs that are worked out when asked for are a row of their
//! own.

use crate::tally::Tally;
use core::hint::black_box;
use gimbal_firmware::cases::{Case, FLIGHT, STOPS};
use gimbal_firmware::counter::Counter;
use gimbal_servo::{Config, Faults, Number};

/// The flight without a part of the model; what it saves is what that part costs.
const WITHOUT_FRICTION: Case = Case { name: "flight-without-friction", config: without_friction, ..FLIGHT };

fn without_friction() -> Config {
    Config::consistent().without_friction()
}

/// What is counted: all of it, or for the profile the flight alone.
pub(crate) fn cases() -> &'static [Case] {
    const CASES: [Case; 3] = [FLIGHT, WITHOUT_FRICTION, STOPS];
    if cfg!(feature = "brief") { &CASES[..1] } else { &CASES }
}

// Not inlined: the laws of all cases at once would not fit the stack of the smallest board.
#[inline(never)]
pub(crate) fn count<N: Number>(counter: &mut Counter, case: &Case, number: &str) -> Result<(), &'static str> {
    let built = (case.config)().build::<N>();
    let Ok(law) = &built else { return Err("the law cannot be built") };
    let mut state = law.start();
    let [mut all, mut events, mut others, mut outputs] = [Tally::EMPTY; 4];
    // The first call has no period behind it and does less.
    law.advance(&mut state, &case.input(law, 0));
    let steps = if cfg!(feature = "brief") { 200 } else { case.steps };
    for k in 1..steps {
        // Hidden from the compiler outside of what is counted.
        let input = black_box(case.input(law, k));
        let mut faults = Faults::NONE;
        let count = counter.count(|| faults = law.advance(&mut state, &input));
        black_box(faults);
        all.add(count);
        let mut output = None;
        outputs.add(counter.count(|| output = Some(law.output(&state))));
        if black_box(output).is_some_and(|output| output.stop_change_age != N::default()) {
            events.add(count);
        } else {
            others.add(count);
        }
    }
    all.print("cost", case.name, number);
    if case.name == FLIGHT.name {
        outputs.print("cost", "output", number);
    }
    if case.name == STOPS.name {
        events.print("cost-events", case.name, number);
        others.print("cost-others", case.name, number);
    }
    Ok(())
}
