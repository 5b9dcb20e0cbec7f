//! What a log is made of before effects: motion, nominal platform, columns, noise.

use gimbal_servo::Config;

use super::Recipe;
use crate::draw::Draw;
use crate::excitation::{Excitation, PERIOD_S};
use crate::scene::Scene;
use crate::sensors::Noise;

/// Which columns a log has beside the needed ones.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::struct_excessive_bools)] // one for each column of the contract
pub(super) struct Columns {
    pub(super) torque: bool,
    pub(super) gimbal: bool,
    pub(super) relative: bool,
    pub(super) cross: bool,
    pub(super) temperature: bool,
}

impl Columns {
    fn draw(excitation: Excitation, draw: &mut Draw) -> Self {
        let (torque, gimbal, relative) = (draw.chance(0.85), draw.chance(0.5), draw.chance(0.5));
        Self {
            torque,
            gimbal: gimbal && excitation.in_laboratory(),
            relative,
            cross: draw.chance(0.7),
            temperature: draw.chance(0.4),
        }
    }

    pub(super) fn names(self) -> Vec<String> {
        [
            (self.torque, "motor_torque_nm"),
            (self.gimbal, "gimbal_angle_rad"),
            (self.relative, "relative_angle_rad"),
            (self.cross, "cross_rate_radps"),
            (self.temperature, "temperature_c"),
        ]
        .into_iter()
        .filter(|(there, _)| *there)
        .map(|(_, name)| name.to_owned())
        .collect()
    }

    /// Places in [`crate::scene::CHANNELS`].
    pub(super) fn channels(self) -> Vec<usize> {
        [true, self.torque, self.gimbal]
            .iter()
            .enumerate()
            .filter(|(_, there)| **there)
            .map(|(place, _)| place)
            .collect()
    }
}

/// What a log is made of before effects.
pub(super) struct Setting {
    pub(super) excitation: Excitation,
    pub(super) preset: &'static str,
    pub(super) nominal: Config,
    pub(super) scene: Scene,
    pub(super) columns: Columns,
    pub(super) noise: Noise,
    pub(super) start_s: f64,
}

fn nominal(draw: &mut Draw) -> (&'static str, Config) {
    let (preset, mut config) =
        if draw.chance(0.1) { ("as-printed", Config::as_printed()) } else { ("consistent", Config::consistent()) };
    if draw.chance(0.3) {
        // another tuning of the same loop
        config.servo.gain_nm_per_rad_s *= 0.8;
    }
    if draw.chance(0.3) {
        let u = config.unbalance.x_kg_m;
        (config.unbalance.x_kg_m, config.unbalance.y_kg_m) = (draw.uniform(-1.0, 1.0) * u, draw.uniform(-1.0, 1.0) * u);
    }
    (preset, config)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // seconds and rows of one log
pub(super) fn setting(recipe: &Recipe, draw: &mut Draw) -> Setting {
    let place = draw.unit();
    // five rich kinds with 16 % each, quiet and sway with 10 % each
    let excitation = if place < 0.8 {
        Excitation::ALL[((place / 0.16) as usize).min(4)]
    } else if place < 0.9 {
        Excitation::Quiet
    } else {
        Excitation::Sway
    };
    let (preset, nominal) = nominal(draw);
    let rows = (libm::round(draw.uniform(recipe.length_s.0, recipe.length_s.1)) / PERIOD_S) as usize;
    let mid_run = draw.chance(0.5);
    let before = if mid_run { (draw.uniform(0.5, 3.0) / PERIOD_S) as usize } else { 0 };
    let start_s = if mid_run { libm::floor(draw.log_uniform(5.0, 900.0)) + before as f64 * PERIOD_S } else { 0.0 };
    let track = excitation.track(rows + before, recipe.rocket.as_ref(), draw);
    let columns = Columns::draw(excitation, draw);
    let noise = Noise::draw(draw);
    Setting { excitation, preset, nominal, scene: Scene { track, before }, columns, noise, start_s }
}
