//! The 1 kHz call on cortex-m-rt alone: the step in the timer's exception, its output to the main loop by a queue.
//!
//! The core's timer is configured by hand, and what the exception owns is handed to it once. Ten seconds of flight; the
//! digest of all outputs is the host's.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(all(target_os = "none", target_arch = "arm")))]
gimbal_firmware::flight_on_host!();

#[cfg(all(target_os = "none", target_arch = "arm"))]
gimbal_firmware::program!(target::run);

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use core::cell::RefCell;
    use cortex_m::peripheral::syst::SystClkSource;
    use cortex_m_rt::exception;
    use critical_section::Mutex;
    use gimbal_firmware::board;
    use gimbal_firmware::cases::FLIGHT;
    use gimbal_servo::{Law, Output, State};
    use heapless::spsc::{Producer, Queue};

    /// One axis, and where its outputs go.
    struct Axis {
        law: &'static Law<f32>,
        state: State<f32>,
        outputs: Producer<'static, Output<f32>>,
        row: u32,
    }

    /// What `run` hands to the exception.
    static AXIS: Mutex<RefCell<Option<Axis>>> = Mutex::new(RefCell::new(None));

    pub(super) fn run() -> Result<(), &'static str> {
        const TWICE: &str = "started twice";
        let law = cortex_m::singleton!(: Option<Law<f32>> = None).ok_or(TWICE)?;
        *law = (FLIGHT.config)().build().ok();
        let law = law.as_ref().ok_or("the law cannot be built")?;
        let queue = cortex_m::singleton!(: Queue<Output<f32>, 8> = Queue::new()).ok_or(TWICE)?;
        let (outputs, mut telemetry) = queue.split();
        let axis = Axis { law, state: law.start(), outputs, row: 0 };
        critical_section::with(|cs| AXIS.replace(cs, Some(axis)));

        let mut timer = cortex_m::Peripherals::take().ok_or(TWICE)?.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(board::COUNTER_HZ / 1_000 - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();

        gimbal_firmware::listen(&mut telemetry);
        Ok(())
    }

    #[exception]
    fn SysTick() {
        static mut AXIS_OF_TICK: Option<Axis> = None;
        if AXIS_OF_TICK.is_none() {
            *AXIS_OF_TICK = critical_section::with(|cs| AXIS.take(cs));
        }
        let Some(axis) = AXIS_OF_TICK else { return };
        // Your sensors' reading goes here.
        let input = FLIGHT.input(axis.law, axis.row);
        let output = axis.law.step(&mut axis.state, input);
        // A full queue shows as a missing step at the end.
        axis.row += u32::from(axis.outputs.enqueue(output).is_ok());
    }
}
