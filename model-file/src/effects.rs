//! `[effects]`: what the axis does beside the nominal equations. Names, parameters and their meaning are those of the
//! plant's table, the one list of them.

use gimbal_plant::{Bound, Effect};
use gimbal_servo::{Config, effects};
use toml::Value;
use toml::de::{DeTable, DeValue};

use crate::error::Problem;
use crate::fields::nearest;
use crate::merge::{self, Wrong};
use crate::place::Places;

/// An effect with its values, in the order of [`Effect::parameters`].
#[derive(Debug, Clone, PartialEq)]
pub struct ModelEffect {
    /// Which.
    pub effect: Effect,
    /// Its values.
    pub values: Vec<f64>,
}

/// Reads the table.
pub(crate) fn read(table: &DeTable, places: &mut Places) -> Result<Vec<ModelEffect>, Wrong> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let mut effects = Vec::new();
    for (key, value) in entries {
        let name = key.get_ref().as_ref();
        let Some(effect) = Effect::from_name(name) else {
            let nearest = nearest(name, Effect::all().map(Effect::name));
            return Err((
                key.span(),
                Problem::UnknownKey { table: "effects".to_owned(), name: name.to_owned(), nearest },
            ));
        };
        let told = format!("effects.{name}");
        let DeValue::Table(given) = value.get_ref() else {
            let expected = format!("a table with {}", listed(effect));
            return Err((value.span(), Problem::WrongType { name: told, found: "no table".to_owned(), expected }));
        };
        // the typical values say which type is right; every one of them must be replaced
        let mut base = toml::Table::new();
        for parameter in effect.parameters() {
            base.insert(parameter.name.to_owned(), Value::Float(parameter.typical));
        }
        merge::table(&told, &mut base, given, places, |_| Ok(()))?;
        let missing = effect.parameters().iter().find(|parameter| given.get(parameter.name).is_none());
        if let Some(parameter) = missing {
            let message = format!("`{told}` lacks `{}`; it takes {}", parameter.name, listed(effect));
            return Err((key.span(), Problem::Impossible(message)));
        }
        let values: Vec<f64> = effect
            .parameters()
            .iter()
            .map(|parameter| base.get(parameter.name).and_then(Value::as_float).unwrap_or_default())
            .collect();
        for (parameter, &value) in effect.parameters().iter().zip(&values) {
            let right = match parameter.bound {
                Bound::NotNegative if value < 0.0 => "zero or positive",
                Bound::Positive if value <= 0.0 => "positive",
                _ => continue,
            };
            let message = format!("`{told}.{}` is {value}; it must be {right}", parameter.name);
            return Err((key.span(), Problem::Impossible(message)));
        }
        effects.push(ModelEffect { effect, values });
    }
    Ok(effects)
}

fn listed(effect: Effect) -> String {
    let names: Vec<String> = effect.parameters().iter().map(|parameter| format!("`{}`", parameter.name)).collect();
    names.join(", ")
}

/// Puts an effect that changes a nominal parameter into the parameters; false where it is not of that kind.
pub fn fold(effect: Effect, values: &[f64], config: &mut Config) -> bool {
    let v = |index: usize| values.get(index).copied().unwrap_or(0.0);
    let (servo, gyro) = (&mut config.servo, &mut config.gyro);
    match effect.name() {
        "friction_level" => config.bearing.load_torque_nm_per_n *= 1.0 + v(0),
        "mass_unbalance" => {
            config.unbalance.x_kg_m += v(0);
            config.unbalance.y_kg_m += v(1);
        }
        "loop_gain" => servo.gain_nm_per_rad_s *= 1.0 + v(0),
        "motor_lag" => servo.motor_lag_s *= 1.0 + v(0),
        "gyro_damping" => gyro.damping_nm_s_per_rad *= 1.0 + v(0),
        "angular_momentum" => gyro.angular_momentum_nm_s *= 1.0 + v(0),
        "stop_angle" => gyro.stop_angle_rad *= 1.0 + v(0),
        "gimbal_inertia" => servo.gimbal_inertia_kg_m2 *= 1.0 + v(0),
        _ => return false,
    }
    true
}

/// The effects that the flight law takes, and the names of those that are for the plant alone.
#[must_use]
pub fn flown(all: &[ModelEffect]) -> (effects::Config, Vec<&'static str>) {
    let (mut flown, mut left_out) = (effects::Config::default(), Vec::new());
    for ModelEffect { effect, values } in all {
        let v = |index: usize| values.get(index).copied().unwrap_or(0.0);
        match effect.name() {
            "constant_torque" => flown.constant_torque_nm = v(0),
            "cable_spring" => flown.cable_spring_nm_per_rad = v(0),
            "viscous_friction" => flown.viscous_friction_nm_s_per_rad = v(0),
            "quadratic_drag" => flown.quadratic_drag_nm_s2_per_rad2 = v(0),
            "anisoelasticity" => flown.anisoelasticity_nm_s4_per_m2 = v(0),
            "stribeck" => (flown.stribeck_excess_nm, flown.stribeck_rate_radps) = (v(0), v(1)),
            "loop_delay" => flown.loop_delay_s = v(0),
            "torque_scale" => flown.torque_scale = v(0),
            "torque_bias" => flown.torque_bias_nm = v(0),
            "pickoff_scale" => flown.pickoff_scale = v(0),
            "pickoff_bias" => flown.pickoff_bias_rad = v(0),
            name => left_out.push(name),
        }
    }
    (flown, left_out)
}
