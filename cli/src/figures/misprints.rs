//! The tables of `docs/misprints.md`, as Markdown.

use std::fmt::Write;

use gimbal_servo::{BuildError, Config};

use super::elasticity::{QUANTITIES, Quantity, free};
use super::slips::{self, PHI_DEG, STOP_DEG};
use crate::sweep::parameter::{PARAMETERS, Parameter};
use crate::sweep::trial::Case;

/// Elasticities below this are left out.
const LEAST: f64 = 0.005;
/// The open difference: the velocity error of figure 7 [m/s].
const PRINTED_MPS: f64 = 0.13;

/// All tables.
pub(super) fn tables() -> Result<String, BuildError> {
    Ok(format!("{}\n{}\n{}", slip_table(), elasticity_table()?, explanation_table()?))
}

fn slip_table() -> String {
    let mut text =
        "### Slips of the decimal point\n\nOne coefficient as printed times 0.01, 0.1, 10 or 100; facts that \
                    hold, of four. Slips that hold fewer than three are counted below.\n\n"
            .to_owned();
    text.push_str("| slip | theta, 1e5 dyne cm | theta, 3e5 dyne cm | phi, 20 g | theta, 20 g | facts held |\n");
    text.push_str("|---|---|---|---|---|---|\n");
    let slips = slips::slips();
    for slip in &slips {
        if let Some(angles) = slip.angles.filter(|_| slip.held() >= 3) {
            let [small, large] = angles.steps_deg;
            let _ = writeln!(
                text,
                "| {} x {} | {small:.3} deg | {large:.3} deg | {:.4} deg | {:.3} deg | {} |",
                slip.symbol,
                slip.factor,
                angles.phi_deg,
                angles.theta_deg,
                slip.held()
            );
        }
    }
    let unstable = slips.iter().filter(|slip| slip.angles.is_none()).count();
    let fewer = slips.iter().filter(|slip| slip.angles.is_some() && slip.held() < 3).count();
    let _ = writeln!(text, "\n{fewer} slips hold fewer than three facts; {unstable} make the loop unstable.");
    text
}

fn elasticity_table() -> Result<String, BuildError> {
    let config = Config::consistent();
    let mut text =
        "### Elasticities\n\nPercent by which a result changes when a coefficient of *consistent* grows by one \
                    percent; blank below 0.005. Without stops, but for the saturation.\n\n| coefficient |"
            .to_owned();
    for Quantity { name, .. } in &QUANTITIES {
        let _ = write!(text, " {name} |");
    }
    text.push_str("\n|---|");
    text.push_str(&"---|".repeat(QUANTITIES.len()));
    text.push_str("\n| *value* |");
    for quantity in &QUANTITIES {
        let _ = write!(text, " *{} {}* |", four_digits(quantity.at(&config)?), quantity.unit);
    }
    text.push('\n');
    for parameter in &PARAMETERS {
        let _ = write!(text, "| {} |", parameter.symbol);
        for quantity in &QUANTITIES {
            let elasticity = quantity.elasticity(&config, parameter)?;
            if elasticity.abs() < LEAST {
                text.push_str(" |");
            } else {
                let _ = write!(text, " {elasticity:+.2} |");
            }
        }
        text.push('\n');
    }
    Ok(text)
}

/// What would close the open difference alone, and what else it would then do.
fn explanation_table() -> Result<String, BuildError> {
    let config = Config::consistent();
    let [_, phi, theta, velocity, ..] = &QUANTITIES;
    let now = velocity.at(&config)?;
    let mut text = format!(
        "### What alone would explain {PRINTED_MPS} m/s\n\nSize needed of each coefficient that the velocity error follows, \
         for {PRINTED_MPS} m/s instead of {now:.4} m/s, and figure 7's angles with it.\n\n"
    );
    text.push_str("| coefficient | as it is | needed | change | phi, 20 g | theta, 20 g | figure 7's angles |\n");
    text.push_str("|---|---|---|---|---|---|---|\n");
    for parameter in &PARAMETERS {
        let elasticity = velocity.elasticity(&config, parameter)?;
        if elasticity.abs() < 0.1 {
            continue;
        }
        let Some(factor) = needed(velocity, &config, parameter, elasticity) else {
            let _ = writeln!(
                text,
                "| {} | {} {} | no size does it in a stable loop | | | | |",
                parameter.symbol,
                four_digits(parameter.get(&config)),
                parameter.unit
            );
            continue;
        };
        let changed = parameter.scaled(&config, factor);
        let (phi_deg, theta_deg) = (phi.at(&changed)?, theta.at(&changed)?);
        let angles = (phi_deg - PHI_DEG.0).abs() <= PHI_DEG.1 && theta_deg < STOP_DEG;
        let _ = writeln!(
            text,
            "| {} | {} {unit} | {} {unit} | {:+.1} % | {phi_deg:.4} deg | {theta_deg:.3} deg | {} |",
            parameter.symbol,
            four_digits(parameter.get(&config)),
            four_digits(factor * parameter.get(&config)),
            100.0 * (factor - 1.0),
            if angles { "still met" } else { "missed" },
            unit = parameter.unit,
        );
    }
    let square = 20.0 * (PRINTED_MPS / now).sqrt();
    let both = free(&config, Case::Both)?;
    let _ = writeln!(
        text,
        "| A | 20 g | {square:.2} g | {:+.1} % | {:.4} deg | {:.3} deg | missed |",
        100.0 * (square / 20.0 - 1.0),
        phi.at(&config)? * square / 20.0,
        theta.at(&config)? * square / 20.0,
    );
    let _ = writeln!(
        text,
        "\nFriction of figure 9 besides the unbalance: {:.4} m/s, phi {:.4} deg, theta {:.3} deg.",
        both[2], both[0], both[1]
    );
    Ok(text)
}

/// The factor that brings the velocity error to the printed one: a few steps along the elasticity; none where they lead
/// to an unstable loop or nowhere.
fn needed(velocity: &Quantity, config: &Config, parameter: &Parameter, elasticity: f64) -> Option<f64> {
    let mut factor = 1.0_f64;
    for _ in 0..8 {
        let here = velocity.at(&parameter.scaled(config, factor)).ok()?;
        factor *= (PRINTED_MPS / here).powf(1.0 / elasticity);
    }
    let reached = velocity.at(&parameter.scaled(config, factor)).ok()?;
    ((reached / PRINTED_MPS - 1.0).abs() < 1e-3).then_some(factor)
}

fn four_digits(value: f64) -> String {
    if (1e-2..1e5).contains(&value.abs()) {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 6")]
        let decimals = (3.0 - value.abs().log10().floor()).max(0.0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.3e}")
    }
}
