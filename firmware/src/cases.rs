//! Input for `digest` and `cost`: the same on the host and on every board, made by integer and plain f64 arithmetic.

use core::f64::consts::PI;
use gimbal_servo::{Config, Digest, Fixed, Input, Interpolation, Law, Number, Output, State};

/// One run: a configuration, and the input row of each step.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Name in results.
    pub name: &'static str,
    /// The axis.
    pub config: fn() -> Config,
    /// Row of step `k`.
    pub row: fn(u32) -> Input<f64>,
    /// Number of steps.
    pub steps: u32,
}

/// Every case.
pub const CASES: [Case; 4] = [
    FLIGHT,
    STOPS,
    Case { name: "range", config: Config::as_printed, row: range_row, steps: 3_000 },
    Case { name: "variant", config: variant, row: variant_row, steps: 3_000 },
];

/// The recorded flight: friction and unbalance act all the time.
pub const FLIGHT: Case = Case { name: "flight", config: Config::consistent, row: flight_row, steps: 10_000 };

/// A torque that throws the gyro from stop to stop.
pub const STOPS: Case = Case { name: "stops", config: Config::consistent, row: stops_row, steps: 10_000 };

/// Makes a `main` for the host that prints what the examples of the 1 kHz call must print on a board: those in Rust the
/// first line, that in C both.
#[macro_export]
macro_rules! flight_on_host {
    () => {
        #[cfg(not(target_os = "none"))]
        fn main() {
            let flight = $crate::cases::FLIGHT;
            println!("tick f32 {} steps {:016x}", flight.steps, flight.output_digest::<f32>());
            println!("tick fixed {} steps {:016x}", flight.steps, flight.single_rows_digest());
        }
        #[cfg(target_os = "none")]
        $crate::program!(elsewhere);
        #[cfg(target_os = "none")]
        fn elsewhere() -> Result<(), &'static str> {
            Err("the examples of the 1 kHz call run on Cortex-M alone")
        }
    };
}

impl Case {
    /// Digest of everything that comes out over the whole case, the INS sums too; 0 if the law cannot be built.
    // Not inlined: the laws of all cases at once would not fit the stack of the smallest board.
    #[must_use]
    #[inline(never)]
    pub fn digest<N: Number>(&self) -> u64 {
        // By reference: a law is some kilobytes, and moving it out would make a copy.
        let built = (self.config)().build::<N>();
        let Ok(law) = &built else { return 0 };
        let mut state = law.start();
        let outputs = self.outputs(law, |row| law.step(&mut state, row));
        with_sums(outputs, law, &state)
    }

    /// Digest of the outputs alone; 0 if the law cannot be built.
    #[must_use]
    #[inline(never)]
    pub fn output_digest<N: Number>(&self) -> u64 {
        let built = (self.config)().build::<N>();
        let Ok(law) = &built else { return 0 };
        let mut state = law.start();
        self.outputs(law, |row| law.step(&mut state, row)).value()
    }

    /// Digest of the outputs in fixed point alone, for rows that a program has in single precision; 0 if the law cannot be
    /// built.
    #[must_use]
    pub fn single_rows_digest(&self) -> u64 {
        let config = (self.config)();
        let (Ok(single), Ok(fixed)) = (config.build::<f32>(), config.build::<Fixed>()) else { return 0 };
        let (mut state, mut digest) = (fixed.start(), Digest::default());
        for k in 0..self.steps {
            let Input { accel_x_mps2, accel_y_mps2, accel_z_mps2, vehicle_rate_radps, .. } = self.input(&single, k);
            let row = Input {
                accel_x_mps2: accel_x_mps2.into(),
                accel_y_mps2: accel_y_mps2.into(),
                accel_z_mps2: accel_z_mps2.into(),
                vehicle_rate_radps: vehicle_rate_radps.into(),
                ..Input::default()
            };
            digest.add_output(&fixed.step(&mut state, fixed.units().input(&row)));
        }
        digest.value()
    }

    /// Steps through the whole case.
    pub(crate) fn outputs<N: Number>(&self, axis: &Law<N>, mut step: impl FnMut(Input<N>) -> Output<N>) -> Digest {
        let mut digest = Digest::default();
        for k in 0..self.steps {
            digest.add_output(&step(self.input(axis, k)));
        }
        digest
    }

    /// Row of step `k` as the law takes it.
    #[must_use]
    pub fn input<N: Number>(&self, law: &Law<N>, k: u32) -> Input<N> {
        law.units().input(&(self.row)(k))
    }
}

/// A digest of outputs, with velocity and position error at the end.
pub(crate) fn with_sums<N: Number>(mut digest: Digest, axis: &Law<N>, state: &State<N>) -> u64 {
    for sum in axis.velocity_error_mps(state).into_iter().chain(axis.position_error_m(state)) {
        digest.add(&sum.to_bits().to_le_bytes());
    }
    digest.value()
}

/// x, y, z [cm/s2] and rate [0.01 deg/s], 100 rows a second.
pub(crate) static FLIGHT_ROWS: [[i16; 4]; 1001] = include!(concat!(env!("OUT_DIR"), "/flight.rs"));

/// The recorded flight at 1 kHz, interpolated linearly.
fn flight_row(k: u32) -> Input<f64> {
    let at = (k / 10) as usize;
    let part = f64::from(k % 10) * 0.1;
    let [row, next] = [at, at + 1].map(|i| FLIGHT_ROWS.get(i).copied().unwrap_or_default());
    let value = |i: usize| f64::from(row[i]) + (f64::from(next[i]) - f64::from(row[i])) * part;
    Input {
        accel_x_mps2: value(0) * 0.01,
        accel_y_mps2: value(1) * 0.01,
        accel_z_mps2: value(2) * 0.01,
        vehicle_rate_radps: value(3) * (0.01 * PI / 180.0),
        ..Input::default()
    }
}

/// 0.035 N m (3.5e5 dyne cm) for 0.4 s, nothing for 0.3 s, the same the other way: contact and release each time.
fn stops_row(k: u32) -> Input<f64> {
    let torque_nm = match k % 1400 {
        0..400 => 0.035,
        700..1100 => -0.035,
        _ => 0.0,
    };
    Input { torque_nm, accel_z_mps2: 9.80665, ..Input::default() }
}

/// Noise over 1.2 times the whole range of every input, with values that are no numbers among it.
fn range_row(k: u32) -> Input<f64> {
    let mut seed = k;
    let range = gimbal_servo::Range::default();
    let mut noise = |largest: f64| {
        seed = mix(seed.wrapping_add(0x9E37_79B9));
        match seed % 1000 {
            0 => f64::NAN,
            1 => f64::INFINITY,
            _ => f64::from(mix(seed).cast_signed()) * (1.2 / 2_147_483_648.0) * largest,
        }
    };
    Input {
        accel_x_mps2: noise(range.radial_accel_mps2),
        accel_y_mps2: noise(range.radial_accel_mps2),
        accel_z_mps2: noise(range.axial_accel_mps2),
        vehicle_rate_radps: noise(range.rate_radps),
        torque_nm: noise(range.torque_nm),
        spin_rate_radps: noise(range.rate_radps),
    }
}

/// What is off by default switched on: cross coupling, held inputs, another period.
fn variant() -> Config {
    let mut config = Config::consistent();
    config.gyro.cross_coupling = true;
    config.interpolation = Interpolation::Held;
    config.period_s = 0.5e-3;
    config
}

/// The flight with a rate about the gyro's spin axis that swings slowly.
fn variant_row(k: u32) -> Input<f64> {
    let swing = (f64::from(k % 1000) - 500.0) * 1e-3;
    Input { spin_rate_radps: swing, ..flight_row(k) }
}

/// Scrambles 32 bits (the finaliser of `MurmurHash3`).
pub(crate) fn mix(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x85EB_CA6B);
    x = (x ^ (x >> 13)).wrapping_mul(0xC2B2_AE35);
    x ^ (x >> 16)
}
