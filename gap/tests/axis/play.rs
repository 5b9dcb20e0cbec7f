//! A load behind a play: a drive whose motion is given, and a load that its two sides push, each a stiff spring with a damper.
//!
//! ```text
//! m u' = contact(q - x, v - u) - f sgn u        effort = (J - m) a + B v + (Fc - f) sgn v + contact
//! ```

use std::fmt::Write;
use std::path::Path;

use gimbal_gap::axis::{AxisDiagnosis, AxisLog, diagnose, text};
use gimbal_model_file::AxisModel;

const MODEL: &str = "[axis]\nmotion = \"linear\"\neffort_unit = \"N\"\ninertia = 2.0\nviscous = 5.0\ncoulomb = 3.0\n\
[axis.columns]\ntime = { name = \"t\", unit = \"s\" }\nposition = { name = \"q\", unit = \"m\" }\n\
effort = { name = \"u\", unit = \"N\" }\n";

const LOAD_KG: f64 = 0.8;
const LOAD_FRICTION_N: f64 = 1.0;
/// Of a contact: 120 Hz, a quarter of what damps it just so.
const CONTACT_RADPS: f64 = 750.0;
const SUB_STEPS: u32 = 50;

/// Two sines, of up to 0.6 m/s and 8 m/s^2: position, rate and acceleration.
fn drive(t: f64) -> (f64, f64, f64) {
    let (fast, slow) = (12.0_f64, 4.3_f64);
    let of = |amplitude: f64, w: f64| {
        let (sine, cosine) = (w * t).sin_cos();
        (amplitude * sine, amplitude * w * cosine, -amplitude * w * w * sine)
    };
    let (a, b) = (of(0.02, fast), of(0.08, slow));
    (a.0 + b.0, a.1 + b.1, a.2 + b.2)
}

/// The log of 20 s at 1 kHz of an axis whose play is so wide.
fn log(play_m: f64) -> String {
    let step_s = 1e-3 / f64::from(SUB_STEPS);
    let (mut x, mut u) = (0.0, drive(0.0).1);
    let mut out = String::from("t,q,u\n");
    let mut noise = 1_u64;
    for row in 0..20_000 {
        let mut effort = 0.0;
        for sub in 0..SUB_STEPS {
            let t = f64::from(row) * 1e-3 + f64::from(sub) * step_s;
            let (q, v, a) = drive(t);
            let apart = q - x;
            let into = apart - apart.clamp(-0.5 * play_m, 0.5 * play_m);
            let pushed = LOAD_KG * CONTACT_RADPS * (CONTACT_RADPS * into + 0.5 * (v - u));
            // a side pushes and does not pull
            let contact = if into == 0.0 || pushed * into < 0.0 { 0.0 } else { pushed };
            u += step_s * (contact - LOAD_FRICTION_N * (u / 1e-3).clamp(-1.0, 1.0)) / LOAD_KG;
            x += step_s * u;
            effort +=
                ((2.0 - LOAD_KG) * a + 5.0 * v + (3.0 - LOAD_FRICTION_N) * v.signum() + contact) / f64::from(SUB_STEPS);
        }
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[allow(clippy::cast_precision_loss, reason = "a random number")]
        let random = (noise >> 33) as f64 / f64::from(1_u32 << 31) - 0.5;
        let t = f64::from(row) * 1e-3;
        let _ = writeln!(out, "{t:.4},{:.7},{:.4}", drive(t + 5e-4).0, effort + 0.1 * random);
    }
    out
}

fn diagnosed(play_m: f64) -> AxisDiagnosis {
    let model = AxisModel::parse(MODEL, "play.toml").expect("reads").expect("an axis");
    let log = AxisLog::read(log(play_m).as_bytes(), Path::new("play.csv"), &model).expect("reads");
    diagnose(log, &model, Vec::new())
}

#[test]
fn cross_a_load_behind_a_play_is_told_with_its_width_mass_and_friction() {
    let diagnosis = diagnosed(1e-3);
    assert_eq!(diagnosis.found[0].effect, "backlash", "{}", text(&diagnosis));
    let parameter = |name: &str| {
        let mut all = diagnosis.found[0].parameters.iter();
        all.find(|parameter| parameter.name == name).expect("a parameter of it").value
    };
    for (name, truth, within) in [("width", 1e-3, 0.1), ("inertia", LOAD_KG, 0.15), ("friction", LOAD_FRICTION_N, 0.3)]
    {
        assert!((parameter(name) / truth - 1.0).abs() < within, "{name}: {}", text(&diagnosis));
    }
}

#[test]
fn cross_a_load_without_play_is_part_of_the_axis() {
    let diagnosis = diagnosed(0.0);
    assert!(diagnosis.found.is_empty(), "{}", text(&diagnosis));
}
