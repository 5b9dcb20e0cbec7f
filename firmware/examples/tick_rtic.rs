//! The 1 kHz call in RTIC 2: the step in a hardware task bound to the timer, its output to `idle` by a queue.
//!
//! Law, state and both ends of the queue are local resources: RTIC hands each to its one task when it starts, and no
//! lock is taken. Ten seconds of flight; the digest of all outputs is the host's.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(all(target_os = "none", target_arch = "arm")))]
gimbal_firmware::flight_on_host!();

#[cfg(all(target_os = "none", target_arch = "arm"))]
gimbal_firmware::panic_handler!();

/// What RTIC asks of a device; a crate of your chip's registers has it.
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod device {
    /// Bits of an interrupt's priority that the chip has.
    pub(crate) const NVIC_PRIO_BITS: u8 = 3;

    /// None is used: the timer is an exception of the core.
    #[allow(dead_code, reason = "named by the code that RTIC makes")]
    #[derive(Clone, Copy)]
    pub(crate) enum Interrupt {}
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
#[rtic::app(device = crate::device, peripherals = false)]
mod app {
    use cortex_m::peripheral::syst::SystClkSource;
    use gimbal_firmware::cases::FLIGHT;
    use gimbal_firmware::semihosting::{println, process};
    use gimbal_firmware::{board, semihosting};
    use gimbal_servo::{Law, Output, State};
    use heapless::spsc::{Consumer, Producer, Queue};

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        law: &'static Law<f32>,
        state: State<f32>,
        outputs: Producer<'static, Output<f32>>,
        telemetry: Consumer<'static, Output<f32>>,
    }

    #[init(local = [built: Option<Law<f32>> = None, queue: Queue<Output<f32>, 8> = Queue::new()])]
    fn init(context: init::Context) -> (Shared, Local) {
        *context.local.built = (FLIGHT.config)().build().ok();
        let Some(law) = context.local.built.as_ref() else {
            println!("error: the law cannot be built");
            semihosting::process::exit(1)
        };
        let (outputs, telemetry) = context.local.queue.split();

        let mut timer = context.core.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(board::COUNTER_HZ / 1_000 - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();
        (Shared {}, Local { law, state: law.start(), outputs, telemetry })
    }

    /// Every millisecond, above everything else.
    #[task(binds = SysTick, priority = 2, local = [law, state, outputs, row: u32 = 0])]
    fn tick(context: tick::Context) {
        let tick::LocalResources { law, state, outputs, row, .. } = context.local;
        // Your sensors' reading goes here.
        let input = FLIGHT.input(law, *row);
        let output = law.step(state, input);
        // A full queue shows as a missing step at the end.
        *row += u32::from(outputs.enqueue(output).is_ok());
    }

    #[idle(local = [telemetry])]
    fn idle(context: idle::Context) -> ! {
        gimbal_firmware::listen(context.local.telemetry);
        process::exit(0)
    }
}
