//! The fast prediction against the reference plant, effect by effect.

mod corpus;

use corpus::{Case, Excitation};
use gimbal_gap::library::apply;
use gimbal_gap::simulate::{Begin, Inputs, Physics, predict};
use gimbal_plant::Effect;
use gimbal_servo::Config;

fn main() {
    for excitation in Excitation::ALL {
        let mut worst = Vec::new();
        for effect in [None].into_iter().chain(Effect::all().map(Some)) {
            let effects: Vec<_> = effect.map(|effect| (effect.name(), effect.typical())).into_iter().collect();
            let case = Case { seed: 5, excitation, seconds: 20.0, effects, drift: 0.0, noise: 0.0 };
            let log = corpus::simulate(&case);
            let mut physics = Physics::nominal(&Config::consistent());
            for (name, values) in &case.effects {
                apply(name, values, &mut physics);
            }
            let c = &log.columns;
            let mut inputs = Inputs {
                period_s: 1e-3,
                accel_mps2: [c[1].clone(), c[2].clone(), c[3].clone()],
                rate_radps: c[4].clone(),
                cross_radps: c[5].clone(),
                ..Inputs::default()
            };
            inputs.complete(&physics.config.bearing, 0.0);
            let mut begin = Begin::at(&physics, &inputs, c[6][0], Some(c[7][0]));
            begin.state[9] = c[8][0];
            let start = std::time::Instant::now();
            let run = predict(&physics, &inputs, &begin, c[0].len());
            let ms = start.elapsed().as_secs_f64() * 1e3;
            let rms = |a: &[f64], b: &[f64]| {
                (a.iter().zip(b).skip(8000).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / (a.len() - 8000) as f64)
                    .sqrt()
            };
            let zero = vec![0.0; c[0].len()];
            worst.push(format!(
                "{:26} theta {:8.1e} of {:8.1e}  torque {:8.1e} of {:8.1e}  {ms:.1} ms",
                effect.map_or("nominal", Effect::name),
                rms(&run.gyro_angle_rad, &c[6]),
                rms(&zero, &c[6]),
                rms(&run.motor_torque_nm, &c[7]),
                rms(&zero, &c[7]),
            ));
        }
        println!("{excitation:?}\n{}", worst.join("\n"));
    }
}
