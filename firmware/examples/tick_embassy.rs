//! The 1 kHz call in Embassy: the step in a task that a ticker wakes each millisecond, its output to the main loop by a
//! queue.
//!
//! The task runs on an executor in an interrupt, so that nothing in thread mode delays it; an executor in thread mode
//! would wait for whatever runs there until it awaits. Ten seconds of flight; the digest of all outputs is the host's.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(all(target_os = "none", target_arch = "arm")))]
gimbal_firmware::flight_on_host!();

#[cfg(all(target_os = "none", target_arch = "arm"))]
gimbal_firmware::program!(target::run);

/// Embassy's time by the core's timer; the crate of your chip has a better one.
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod time {
    use core::cell::RefCell;
    use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
    use core::task::Waker;
    use cortex_m::peripheral::SYST;
    use cortex_m::peripheral::syst::SystClkSource;
    use cortex_m_rt::exception;
    use critical_section::Mutex;
    use embassy_time_driver::{Driver, TICK_HZ};
    use embassy_time_queue_utils::Queue;
    use gimbal_firmware::board;

    struct Timer {
        /// 49 days.
        ticks: AtomicU32,
        queue: Mutex<RefCell<Queue>>,
    }

    embassy_time_driver::time_driver_impl!(static TIMER: Timer = Timer {
        ticks: AtomicU32::new(0),
        queue: Mutex::new(RefCell::new(Queue::new())),
    });

    impl Driver for Timer {
        fn now(&self) -> u64 {
            self.ticks.load(Relaxed).into()
        }

        fn schedule_wake(&self, at: u64, waker: &Waker) {
            // Looked at again with each tick.
            critical_section::with(|cs| self.queue.borrow_ref_mut(cs).schedule_wake(at, waker));
        }
    }

    pub(crate) fn start(mut timer: SYST) {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(board::COUNTER_HZ / u32::try_from(TICK_HZ).unwrap_or(1_000) - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();
    }

    #[exception]
    fn SysTick() {
        TIMER.ticks.store(TIMER.ticks.load(Relaxed) + 1, Relaxed);
        critical_section::with(|cs| TIMER.queue.borrow_ref_mut(cs).next_expiration(TIMER.now()));
    }
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    // An interrupt's number is a promise to the hardware, and enabling one is too.
    #![allow(unsafe_code)]

    use cortex_m::interrupt::InterruptNumber;
    use cortex_m_rt::exception;
    use embassy_executor::InterruptExecutor;
    use embassy_time::{Duration, Ticker};
    use gimbal_firmware::cases::FLIGHT;
    use gimbal_servo::{Law, Output};
    use heapless::spsc::{Producer, Queue};

    /// An interrupt that nothing else on the board uses; here the first one.
    #[derive(Clone, Copy)]
    struct Executor;

    // SAFETY: every core has an interrupt 0.
    unsafe impl InterruptNumber for Executor {
        fn number(self) -> u16 {
            0
        }
    }

    static EXECUTOR: InterruptExecutor = InterruptExecutor::new();

    /// The interrupts' handler; 0 is the only one enabled.
    #[exception]
    unsafe fn DefaultHandler(_number: i16) {
        // SAFETY: `run` has started the executor before the interrupt is enabled, and this is its interrupt.
        unsafe { EXECUTOR.on_interrupt() };
    }

    pub(super) fn run() -> Result<(), &'static str> {
        const TWICE: &str = "started twice";
        let mut peripherals = cortex_m::Peripherals::take().ok_or(TWICE)?;
        let law = cortex_m::singleton!(: Option<Law<f32>> = None).ok_or(TWICE)?;
        *law = (FLIGHT.config)().build().ok();
        let law = law.as_ref().ok_or("the law cannot be built")?;
        let queue = cortex_m::singleton!(: Queue<Output<f32>, 8> = Queue::new()).ok_or(TWICE)?;
        let (outputs, mut telemetry) = queue.split();

        // SAFETY: no critical section relies on the priority; the timer stays above the executor.
        unsafe { peripherals.NVIC.set_priority(Executor, 0x80) };
        EXECUTOR.start(Executor).spawn(axis(law, outputs).map_err(|_| TWICE)?);
        crate::time::start(peripherals.SYST);

        gimbal_firmware::listen(&mut telemetry);
        Ok(())
    }

    #[embassy_executor::task]
    async fn axis(law: &'static Law<f32>, mut outputs: Producer<'static, Output<f32>>) {
        let mut state = law.start();
        let mut ticker = Ticker::every(Duration::from_millis(1));
        let mut row = 0;
        loop {
            ticker.next().await;
            // Your sensors' reading goes here.
            let input = FLIGHT.input(law, row);
            let output = law.step(&mut state, input);
            // A full queue shows as a missing step at the end.
            row += u32::from(outputs.enqueue(output).is_ok());
        }
    }
}
