//! How the errors grow with the acceleration under friction: local exponents, as they are.

use std::fmt::Write;

use gimbal_servo::Config;

use crate::axis::{Run, System, run, run_plant};
use crate::inputs::friction_profile;

const ACCELS_G: [f64; 7] = [1.0, 2.0, 4.0, 8.0, 12.0, 16.0, 20.0];

/// The section of the page.
pub(super) fn table() -> String {
    let config = Config::consistent().without_unbalance();
    let rows = ACCELS_G.map(|accel_g| friction_profile(accel_g, 1e-3));
    let runs: [Vec<Run>; 3] = [
        rows.iter().map(|rows| run(System::F32, &config, rows)).collect(),
        rows.iter().map(|rows| run(System::Fixed, &config, rows)).collect(),
        rows.iter().map(|rows| run_plant(&config, rows)).collect(),
    ];
    let mut text = "
## Growth under friction

Local exponents of peak phi and of the velocity error in the acceleration, friction run of the paper (figures 9 and 10). Both
follow the friction level, the velocity error times A once more. Below 9.2 g (6.1) holds, where the radial load hardly adds to
the preload's torque; above it (6.2) grows with A to the 1.33, beside a viscous part that does not grow.

| from, to | phi: f32 | fixed | plant | velocity error: f32 | fixed | plant |
|---|---|---|---|---|---|---|
"
    .to_owned();
    for i in 1..ACCELS_G.len() {
        let step = (ACCELS_G[i] / ACCELS_G[i - 1]).ln();
        let mut line = format!("| {} g, {} g |", ACCELS_G[i - 1], ACCELS_G[i]);
        for of in [Run::peak_phi_rad as fn(&Run) -> f64, Run::velocity_error_mps] {
            for runs in &runs {
                write!(line, " {:.3} |", (of(&runs[i]) / of(&runs[i - 1])).ln() / step).expect("a string takes all");
            }
        }
        text += &line;
        text.push('\n');
    }
    text
}
