//! The step with every effect: all of it, outputs too, of which the effects change two. In a program of its own: beside
//! the nominal step the compiler would share functions that neither has to share where it flies.

use crate::tally::Tally;
use core::hint::black_box;
use gimbal_firmware::corrected::FLIGHT_WITH_ALL;
use gimbal_firmware::counter::Counter;
use gimbal_firmware::semihosting::println;
use gimbal_servo::effects::{Law, State};
use gimbal_servo::{Fixed, Number};

pub(crate) fn run(counter: &mut Counter) -> Result<(), &'static str> {
    let [float, fixed] = FLIGHT_WITH_ALL.images;
    count::<f32>(counter, float, "f32")?;
    count::<Fixed>(counter, fixed, "fixed")
}

#[inline(never)]
fn count<N: Number>(counter: &mut Counter, image: &[u8], number: &str) -> Result<(), &'static str> {
    println!("size-effects {number} {} {}", size_of::<State<N>>(), size_of::<Law<N>>());
    let mut law = Law::<N>::BLANK;
    law.read_image(image).map_err(|_| "the image is not one of this library")?;
    let case = FLIGHT_WITH_ALL.case;
    let (mut state, mut all) = (law.start(), Tally::EMPTY);
    // The first call has no period behind it and does less.
    law.step(&mut state, case.input(law.axis(), 0));
    for k in 1..case.steps {
        let input = black_box(case.input(law.axis(), k));
        all.add(counter.count(|| {
            black_box(law.step(&mut state, input));
        }));
    }
    all.print("cost", case.name, number);
    Ok(())
}
