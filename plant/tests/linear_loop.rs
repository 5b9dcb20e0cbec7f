//! The free linear loop against a matrix exponential, with F(s) in another form.

use gimbal_plant::{Plant, Row};
use gimbal_servo::Config;

/// phi, phi', theta, theta', and F(s)/(1+T s) as a chain of integrators; the last entry is the constant torque.
const ORDER: usize = 11;
type Matrix = [[f64; ORDER]; ORDER];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut c = [[0.0; ORDER]; ORDER];
    for i in 0..ORDER {
        for j in 0..ORDER {
            c[i][j] = (0..ORDER).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    c
}

/// exp(A) by a Taylor series of A / 2^20, squared twenty times.
fn exponential(a: &Matrix) -> Matrix {
    let small = a.map(|row| row.map(|entry| entry / f64::from(1 << 20)));
    // exp - 1 is what is squared, so that nothing is lost next to the unit matrix
    let mut term = small;
    let mut rest = small;
    for order in 2..8 {
        term = product(&term, &small).map(|row| row.map(|entry| entry / f64::from(order)));
        for (row, added) in rest.iter_mut().zip(&term) {
            for (entry, more) in row.iter_mut().zip(added) {
                *entry += more;
            }
        }
    }
    for _ in 0..20 {
        let square = product(&rest, &rest);
        for (row, more) in rest.iter_mut().zip(&square) {
            for (entry, added) in row.iter_mut().zip(more) {
                *entry = 2.0 * *entry + added;
            }
        }
    }
    for (index, row) in rest.iter_mut().enumerate() {
        row[index] += 1.0;
    }
    rest
}

/// Coefficients of the product of `1 + T s`, rising powers.
fn polynomial(time_constants_s: &[f64]) -> Vec<f64> {
    let mut coefficients = vec![1.0];
    for constant in time_constants_s {
        coefficients.push(0.0);
        for power in (1..coefficients.len()).rev() {
            coefficients[power] += constant * coefficients[power - 1];
        }
    }
    coefficients
}

/// The loop's matrix, time in units of `unit_s`: the chain's states then have like sizes.
fn matrix(config: &Config, unit_s: f64) -> Matrix {
    let scaled = |constants: &[f64]| constants.iter().map(|constant| constant / unit_s).collect::<Vec<_>>();
    let servo = &config.servo;
    let zeros = polynomial(&scaled(&servo.lead_time_constants_s));
    let mut lags = servo.lag_time_constants_s.to_vec();
    lags.push(servo.motor_lag_s);
    let poles = polynomial(&scaled(&lags));
    // F/(1+Ts) = K unit (z0 + z1 s + ... z5 s^5) / (s (p0 + ... + p5 s^5)), s in 1/unit
    let inertia = servo.gimbal_inertia_kg_m2 / (unit_s * unit_s);
    let float = config.gyro.float_inertia_kg_m2 / (unit_s * unit_s);
    let momentum = config.gyro.angular_momentum_nm_s / unit_s;
    let damping = config.gyro.damping_nm_s_per_rad / unit_s;
    let mut a = [[0.0; ORDER]; ORDER];
    a[0][1] = 1.0;
    a[1][3] = -momentum / inertia;
    a[1][10] = 1.0 / inertia;
    a[2][3] = 1.0;
    a[3][1] = momentum / float;
    a[3][3] = -damping / float;
    for link in 4..9 {
        a[link][link + 1] = 1.0;
    }
    a[9][2] = 1.0 / poles[5];
    for power in 0..5 {
        a[9][5 + power] = -poles[power] / poles[5];
    }
    for (power, zero) in zeros.iter().enumerate() {
        a[1][4 + power] = -servo.gain_nm_per_rad_s * unit_s * zero / inertia;
    }
    a
}

#[test]
fn cross_the_step_response_is_the_matrix_exponential_of_the_loop() {
    for preset in [Config::consistent(), Config::as_printed()] {
        let mut config = preset.without_friction().without_unbalance();
        config.gyro.stop_angle_rad = 100.0;
        let unit_s = 2e-3;
        let step = exponential(&matrix(&config, unit_s).map(|row| row.map(|entry| entry * 1e-3 / unit_s)));
        let torque_nm = 0.01;
        let plant = Plant::new(&config).unwrap();
        let mut x = [0.0; ORDER];
        x[10] = torque_nm;
        let mut worst = [0.0_f64; 2];
        let mut peak = [0.0_f64; 2];
        for sample in plant.run(std::iter::repeat_n(Row { torque_nm, ..Row::default() }, 5001)) {
            for (index, (exact, value)) in
                [(x[0], sample.gimbal_angle_rad), (x[2], sample.gyro_angle_rad)].into_iter().enumerate()
            {
                worst[index] = worst[index].max((exact - value).abs());
                peak[index] = peak[index].max(exact.abs());
            }
            x = step.map(|row| row.iter().zip(&x).map(|(a, b)| a * b).sum());
        }
        for index in 0..2 {
            assert!(worst[index] < 1e-9 * peak[index], "{worst:?} {peak:?}");
        }
    }
}
