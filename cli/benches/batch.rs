//! Steps a second of the batch, of a plain scalar loop, and of what scripts use for the same: `scipy.signal.lfilter` and
//! `control.forced_response`, which know the linear loop alone.
//!
//! `cargo bench -p gimbal-cli --bench batch` prints the table of `docs/benchmarks.md`. The four are measured in turn, the
//! median of the rounds is told, and ratios are taken round by round. Seconds are those that a thread was on a processor,
//! so that other work on the machine counts as little as it can.

use std::array::from_fn;
use std::process::Command;
use std::time::Instant;

use gimbal_servo::batch::{Batch, Processor, Rows, side_by_side};
use gimbal_servo::{Config, Input, Law};

#[allow(dead_code, reason = "the command's own")]
#[path = "../src/sweep/processor.rs"]
mod processor;
use processor::Work;

const LANES: usize = 32;
/// Rows that are gone through again and again.
const ROWS: usize = 2000;
const STEPS: usize = 100_000;
const ROUNDS: usize = 5;

/// What is run: platforms that differ, each with rows of its own.
struct Load {
    laws: Vec<Law<f32>>,
    rows: Vec<Rows<LANES>>,
}

/// A load through the batch.
struct Batches<'a>(&'a Load);

impl Work for Batches<'_> {
    type Output = [u8; gimbal_servo::SAVED_LEN];

    fn on(self, processor: impl Processor) -> Self::Output {
        let Load { laws, rows } = self.0;
        let mut batch = Batch::new(from_fn(|lane| &laws[lane]));
        for step in 0..STEPS {
            std::hint::black_box(batch.step_on(processor, &rows[step % ROWS]));
        }
        laws[LANES - 1].save(&batch.state(LANES - 1))
    }
}

/// Name of the vectors that the batch uses.
fn vectors() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if processor::x86_64::Avx512::detect().is_some() {
            return "AVX-512";
        }
        if processor::x86_64::Avx2::detect().is_some() {
            return "AVX2";
        }
    }
    "baseline"
}

/// A row of a lane: a manoeuvre, every number of which changes each millisecond; the rate reverses and friction with it.
fn row(index: usize, lane: usize) -> Input<f64> {
    let time = index as f64 * 1e-3;
    let size = 1.0 + 0.01 * lane as f64;
    Input {
        accel_x_mps2: 9.0 * (3.1 * time).sin(),
        accel_y_mps2: size * (40.0 + 30.0 * (1.7 * time).sin()),
        accel_z_mps2: 9.81 + 4.0 * (7.0 * time).cos(),
        vehicle_rate_radps: 0.3 * (std::f64::consts::TAU * time).sin(),
        ..Input::default()
    }
}

fn load() -> Load {
    let laws: Vec<Law<f32>> = (0..LANES)
        .map(|lane| {
            let mut config = Config::consistent();
            config.servo.gain_nm_per_rad_s *= 1.0 + 1e-3 * lane as f64;
            config.bearing.preload_n *= 1.0 + 1e-2 * lane as f64;
            config.build().expect("a preset, a little changed")
        })
        .collect();
    let rows =
        (0..ROWS).map(|index| side_by_side(&from_fn(|lane| laws[lane].units().input(&row(index, lane))))).collect();
    Load { laws, rows }
}

/// The last lane through the scalar step.
fn scalar(load: &Load) -> [u8; gimbal_servo::SAVED_LEN] {
    let law = &load.laws[LANES - 1];
    let mut state = law.start();
    for step in 0..STEPS {
        std::hint::black_box(law.step(&mut state, load.rows[step % ROWS].lane(LANES - 1)));
    }
    law.save(&state)
}

/// Seconds that this thread has been on a processor; of the clock where the system does not tell.
fn on_processor_s(start: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|told| told.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

/// Steps a second of some work.
fn pace<R>(steps: usize, work: impl FnOnce() -> R) -> (f64, R) {
    let start = Instant::now();
    let from = on_processor_s(start);
    let result = work();
    (steps as f64 / (on_processor_s(start) - from), result)
}

/// Both threads at once, each with its own lanes: their sum, and by the clock.
fn two_threads(load: &Load) -> (f64, f64) {
    let start = Instant::now();
    let paces: f64 = std::thread::scope(|scope| {
        let threads = [(); 2].map(|()| scope.spawn(|| pace(STEPS * LANES, || processor::on_this(Batches(load))).0));
        threads.into_iter().map(|thread| thread.join().expect("it does not panic")).sum()
    });
    (paces, (2 * STEPS * LANES) as f64 / start.elapsed().as_secs_f64())
}

/// Steps a second of a peer, or why there is none.
fn peer(name: &str) -> Result<f64, String> {
    let output = Command::new("python3").args(["-c", PEERS, name]).output();
    let output = output.map_err(|error| format!("python3 does not start: {error}"))?;
    if !output.status.success() {
        let told = String::from_utf8_lossy(&output.stderr);
        return Err(told.trim().lines().last().unwrap_or("python3 fails").to_owned());
    }
    let told = String::from_utf8_lossy(&output.stdout);
    told.trim().parse().map_err(|_| format!("python3 says `{}`", told.trim()))
}

/// The paper's loop from disturbance torque to gyro angle: (1) to (4), the consistent set, 32 runs of 10 s.
const PEERS: &str = "
import sys, time
import numpy as np
from numpy.polynomial import polynomial as P
name = sys.argv[1]
jg, jo, bo, h, k, t = 3.2964e-3, 3.4e-5, 9.27e-3, 4e-2, 8.3448323, 1e-3
lead, lag = [2.16, 0.0385, 0.0156, 0.0127, 0.168], [2.24, 3.06e-3, 1.68e-3, 1.31e-3]
def product(constants):
    p = [1.0]
    for c in constants:
        p = P.polymul(p, [1.0, c])
    return p
d = P.polymul([0.0, 1.0], product(lag + [t]))
n = k * product(lead)
a = P.polyadd(P.polymul([0, 0, jg * bo / h, jg * jo / h], d), P.polyadd(P.polymul([0.0, h], d), n))
num, den = d[::-1], a[::-1]
samples, runs = 10001, 32
if name == 'scipy':
    from scipy import signal
    b, a, _ = signal.cont2discrete((num, den), 1e-3, method='zoh')
    x = np.random.default_rng(1).normal(size=(runs, samples))
    b = b.ravel()
    work = lambda: signal.lfilter(b, a, x, axis=1)
    steps = runs * samples
else:
    import control
    system = control.sample_system(control.ss(control.tf(num, den)), 1e-3, method='zoh')
    u = np.random.default_rng(1).normal(size=samples)
    time_s = np.arange(samples) * 1e-3
    work = lambda: control.forced_response(system, time_s, u)
    steps = samples
with np.errstate(all='ignore'):
    work()
    best = 0.0
    for _ in range(5):
        start = time.process_time()
        work()
        best = max(best, steps / (time.process_time() - start))
print(best)
";

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

fn main() {
    let load = load();
    let mut paces: [Vec<f64>; 6] = from_fn(|_| Vec::new());
    let mut absent = [None, None];
    for round in 1..=ROUNDS {
        let (batch, of_batch) = pace(STEPS * LANES, || processor::on_this(Batches(&load)));
        let (single, of_scalar) = pace(STEPS, || scalar(&load));
        assert_eq!(of_batch, of_scalar, "the batch has other bits than the scalar step");
        let (two, by_clock) = two_threads(&load);
        for (pace, value) in paces.iter_mut().zip([two, by_clock, batch, single]) {
            pace.push(value);
        }
        for (place, name) in ["scipy", "control"].into_iter().enumerate() {
            match peer(name) {
                Ok(pace) => paces[4 + place].push(pace),
                Err(why) => absent[place] = Some(why),
            }
        }
        eprintln!("round {round} of {ROUNDS}");
    }
    println!("Vectors: {}. Median of {ROUNDS} rounds; the batch's bits are those of the scalar step.\n", vectors());
    println!("| what | steps a second | batch on two threads is faster by |");
    println!("|---|---|---|");
    let names = [
        "batch, two threads, per second on a processor",
        "batch, two threads, by the clock",
        "batch, one thread",
        "plain scalar loop of the step, one thread",
        "`scipy.signal.lfilter`, f64, 32 runs, linear loop alone",
        "`control.forced_response`, linear loop alone",
    ];
    for (place, name) in names.into_iter().enumerate() {
        if let Some(why) = place.checked_sub(4).and_then(|peer| absent[peer].as_ref()) {
            println!("| {name} | NOT MEASURED: {why} | |");
            continue;
        }
        let ratios: Vec<f64> = paces[0].iter().zip(&paces[place]).map(|(batch, other)| batch / other).collect();
        println!("| {name} | {:.2e} | {:.1} |", median(&paces[place]), median(&ratios));
    }
}
