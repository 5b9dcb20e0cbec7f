//! What the paper says of the course: growth with the acceleration, and what stays after it.

use gimbal_servo::{BuildError, Config};

use super::super::growth::exponents as exponents_of;
use super::{Fact, Verdict};
use crate::run::flight::Flight;
use crate::run::model::{Initial, Model};
use crate::run::profile::Profile;
use crate::sweep::trial::Case;

/// Figures 7 to 10: growth with the acceleration.
pub(super) fn growth(consistent: &Config, printed: &Config) -> Result<Vec<Fact>, BuildError> {
    let exponents = |config: &Config, case, span_g| {
        // As printed the gyro would be on its stop: the law of growth is that of the loop.
        let mut free = *config;
        free.gyro.stop_angle_rad = 1e3;
        exponents_of(&free, case, span_g)
    };
    let mut facts = Vec::new();
    for (case, place, names) in [
        (
            Case::Unbalance,
            "figures 7, 8",
            ["unbalance: phi grows as A^n", "unbalance: theta grows as A^n", "unbalance: velocity error grows as A^n"],
        ),
        (
            Case::Friction,
            "figures 9, 10",
            ["friction: phi grows as A^n", "friction: theta grows as A^n", "friction: velocity error grows as A^n"],
        ),
    ] {
        let (all, high) = ((1.0, 20.0), (15.0, 25.0));
        let (ours, theirs) = (exponents(consistent, case, all)?, exponents(printed, case, all)?);
        let (ours_high, theirs_high) = (exponents(consistent, case, high)?, exponents(printed, case, high)?);
        for (index, name) in names.into_iter().enumerate() {
            let published = if index < 2 { 1.0 } else { 2.0 };
            let text = |all: f64, high: f64| format!("n = {all:.3} from 1 to 20 g, {high:.3} about 20 g");
            // "In proportion" and "nearly": within a tenth over the range of the figures.
            let agrees = |exponents: &[f64; 3]| (exponents[index] - published).abs() <= 0.1;
            facts.push(Fact {
                name,
                place,
                published: if index < 2 { "in proportion, n = 1" } else { "nearly the square, n = 2" }.to_owned(),
                consistent: text(ours[index], ours_high[index]),
                printed: text(theirs[index], theirs_high[index]),
                difference: format!("{:+.3}", ours[index] - published),
                verdict: match (agrees(&ours), agrees(&ours_high)) {
                    (true, _) => Verdict::Agrees,
                    (false, true) => Verdict::InPart,
                    (false, false) => Verdict::Open,
                },
            });
        }
    }
    Ok(facts)
}

/// After the acceleration the velocity error stays and the position error goes on along that slope.
pub(super) fn after(consistent: &Config, printed: &Config) -> Result<Vec<Fact>, BuildError> {
    let after = |config: &Config| {
        let config = Case::Unbalance.config(config);
        let mut model = Flight::<f32>::new(&config, Initial::Zero)?;
        let mut at_5_s = None;
        let rows = Profile::len(config.period_s);
        for k in 0..rows {
            model.step(&Profile::Unbalance.row(k, config.period_s).into());
            if k == rows / 2 {
                at_5_s = Some(model.sample());
            }
        }
        let end = model.sample();
        let start = at_5_s.unwrap_or(end);
        let velocity = end.velocity_error_mps[0];
        let drift = velocity / start.velocity_error_mps[0] - 1.0;
        let slope = (end.position_error_m[0] - start.position_error_m[0]) / (velocity * 5.0) - 1.0;
        Ok::<[f64; 2], BuildError>([drift, slope])
    };
    let (ours, theirs) = (after(consistent)?, after(printed)?);
    let names =
        ["velocity error stays constant after the acceleration", "position error goes on along the velocity error"];
    Ok((0..2)
        .map(|i| Fact {
            name: names[i],
            place: "figure 7",
            published: "constant slope".to_owned(),
            consistent: format!("within {:.3} % over 5 s", 100.0 * ours[i].abs()),
            printed: format!("within {:.3} % over 5 s", 100.0 * theirs[i].abs()),
            difference: String::new(),
            verdict: if ours[i].abs() < 1e-3 { Verdict::Agrees } else { Verdict::Open },
        })
        .collect())
}
