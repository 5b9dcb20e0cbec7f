//! Counts the instructions of the step, each single one of ten seconds of flight and of ten seconds between the stops.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
gimbal_firmware::program!(target::run);

#[cfg(target_os = "none")]
mod target {
    use core::hint::black_box;
    use gimbal_firmware::cases::{Case, FLIGHT, STOPS};
    use gimbal_firmware::{counter::Counter, semihosting::println};
    use gimbal_servo::{Config, Fixed, Law, Number, State};

    /// Counts of the steps of one kind.
    #[derive(Clone, Copy)]
    struct Tally {
        steps: u32,
        sum: u64,
        min: u32,
        max: u32,
    }

    impl Tally {
        const EMPTY: Self = Self { steps: 0, sum: 0, min: u32::MAX, max: 0 };

        fn add(&mut self, count: u32) {
            self.steps += 1;
            self.sum += u64::from(count);
            self.min = self.min.min(count);
            self.max = self.max.max(count);
        }

        /// Mean in thousandths of an instruction: text of a float would need the code to print it.
        fn print(&self, kind: &str, name: &str, number: &str) {
            if self.steps > 0 {
                let mean_milli = self.sum * 1000 / u64::from(self.steps);
                println!("{kind} {name} {number} {} {} {mean_milli} {}", self.steps, self.min, self.max);
            }
        }
    }

    /// The flight without a part of the model; what it saves is what that part costs.
    const WITHOUT_FRICTION: Case = Case { name: "flight-without-friction", config: without_friction, ..FLIGHT };

    fn without_friction() -> Config {
        Config::consistent().without_friction()
    }

    pub(crate) fn run() -> Result<(), &'static str> {
        let mut counter = Counter::start();
        println!("size f32 {} {}", size_of::<State<f32>>(), size_of::<Law<f32>>());
        println!("size fixed {} {}", size_of::<State<Fixed>>(), size_of::<Law<Fixed>>());
        let cases = [FLIGHT, WITHOUT_FRICTION, STOPS];
        for case in if cfg!(feature = "brief") { &cases[..1] } else { &cases } {
            count::<f32>(&mut counter, case, "f32")?;
            count::<Fixed>(&mut counter, case, "fixed")?;
        }
        Ok(())
    }

    // Not inlined: the laws of all cases at once would not fit the stack of the smallest board.
    #[inline(never)]
    fn count<N: Number>(counter: &mut Counter, case: &Case, number: &str) -> Result<(), &'static str> {
        let built = (case.config)().build::<N>();
        let Ok(law) = &built else { return Err("the law cannot be built") };
        let mut state = law.start();
        let (mut all, mut events) = (Tally::EMPTY, Tally::EMPTY);
        // The first call has no period behind it and does less.
        let mut output = law.step(&mut state, case.input(law, 0));
        let steps = if cfg!(feature = "brief") { 200 } else { case.steps };
        for k in 1..steps {
            // Hidden from the compiler outside of what is counted.
            let input = black_box(case.input(law, k));
            let count = counter.count(|| output = law.step(&mut state, input));
            output = black_box(output);
            all.add(count);
            if output.stop_change_age != N::default() {
                events.add(count);
            }
        }
        all.print("cost", case.name, number);
        events.print("cost-events", case.name, number);
        Ok(())
    }
}
