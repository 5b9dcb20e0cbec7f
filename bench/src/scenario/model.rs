//! Model and platform of a scenario.

use std::path::Path;

use gimbal_model_file::{ModelFile, Preset};
use gimbal_plant::{Effect, Plant};
use gimbal_servo::{Config, estimator};

use super::{Part, Scenario};

impl Scenario {
    /// The model of a preset or file, without what is taken out.
    pub(crate) fn axis(&self, name: &str) -> Result<(Config, estimator::Config), String> {
        let model = match name {
            "consistent" => ModelFile::preset(Preset::Consistent),
            "as-printed" => ModelFile::preset(Preset::AsPrinted),
            file => {
                let path = self.folder.as_deref().unwrap_or(Path::new(".")).join(file);
                ModelFile::open(&path).map_err(|error| error.to_string())?
            }
        };
        model.without_effects("a scenario").map_err(|error| error.to_string())?;
        let mut config = model.config;
        for part in &self.without {
            config = match part {
                Part::Friction => config.without_friction(),
                Part::Unbalance => config.without_unbalance(),
            };
        }
        let mut settings = estimator::Config { tolerance: model.tolerance.estimator(), ..estimator::Config::default() };
        settings.sensors.gyro_noise_rad = self.noise.gyro_angle_rad.max(1e-9);
        settings.sensors.gyro_step_rad = self.noise.gyro_step_rad;
        settings.sensors.motor_torque_noise_nm = self.noise.motor_torque_nm;
        Ok((config, settings))
    }

    /// The platform with its effects.
    pub(crate) fn plant(&self) -> Result<Plant, String> {
        let (config, _) = self.axis(&self.model)?;
        // Far below the sensors' noise, and three times faster than the default.
        let mut plant = Plant::new(&config).map_err(|error| error.to_string())?.with_tolerance(1e-7);
        for entry in &self.effects {
            let effect = Effect::from_name(&entry.name).ok_or_else(|| {
                let names: Vec<&str> = Effect::all().map(Effect::name).collect();
                format!("`{}` is no effect; there are {}", entry.name, names.join(", "))
            })?;
            let values = if entry.values.is_empty() { effect.typical() } else { entry.values.clone() };
            plant = plant.with_effect(effect, &values).map_err(|error| error.to_string())?;
        }
        Ok(plant)
    }
}
