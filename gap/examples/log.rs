//! A simulated log as CSV: `cargo run --release -p gimbal-gap --example log -- manoeuvre 20 23 0.6 cable_spring=1e-3 > log.csv`
//! (excitation, seconds, seed, drift of the nominal parameters over their tolerance, effects with their values; `name` alone has typical ones).

mod corpus;

use std::io::Write;

use corpus::{Case, Excitation, simulate};
use gimbal_plant::Effect;

fn main() -> std::io::Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let excitation = match args.first().map(String::as_str) {
        Some("table") => Excitation::RateTable,
        Some("flight") => Excitation::Flight,
        _ => Excitation::Manoeuvre,
    };
    let number = |index: usize, default: f64| args.get(index).map_or(default, |text| text.parse().expect("a number"));
    let effects = args.iter().skip(4).map(|text| {
        let (name, values) = text.split_once('=').unwrap_or((text, ""));
        let effect = Effect::from_name(name).expect("an effect");
        let given: Vec<f64> = values.split(',').filter_map(|value| value.parse().ok()).collect();
        (effect.name(), if given.is_empty() { effect.typical() } else { given })
    });
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a seed")]
    let seed = number(2, 23.0) as u64;
    let case = Case {
        seed,
        excitation,
        seconds: number(1, 20.0),
        effects: effects.collect(),
        drift: number(3, 0.6),
        noise: 1.0,
    };
    let columns = simulate(&case).columns;
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    writeln!(
        out,
        "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps,cross_rate_radps,gyro_angle_rad,motor_torque_nm"
    )?;
    for k in 0..columns[0].len() {
        let row: Vec<String> = columns[..8].iter().map(|column| column[k].to_string()).collect();
        writeln!(out, "{}", row.join(","))?;
    }
    out.flush()
}
