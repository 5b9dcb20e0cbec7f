//! Smallest sizes of limits, stops and steps, against simulated logs: beyond them the effect is named, well before them not.

#[path = "../examples/corpus/mod.rs"]
mod corpus;

use corpus::{Case, Excitation, as_log, simulate};
use gimbal_gap::judge::{Detectable, Seen};
use gimbal_gap::{Diagnosis, diagnose};
use gimbal_model_file::ModelFile;

fn diagnosed(effects: Vec<(&'static str, Vec<f64>)>) -> Diagnosis {
    let case = Case { seed: 4, excitation: Excitation::Manoeuvre, seconds: 15.0, effects, drift: 0.0, noise: 1.0 };
    diagnose(&as_log(&simulate(&case)), &ModelFile::default())
}

fn told<'a>(diagnosis: &'a Diagnosis, name: &str) -> &'a Detectable {
    diagnosis.detectable.iter().find(|own| own.effect == name).expect("an effect of the library")
}

fn names(diagnosis: &Diagnosis) -> Vec<&'static str> {
    diagnosis.decision.iter().flat_map(|decision| decision.found.iter().map(|found| found.effect)).collect()
}

#[test]
fn closed_form_limits_stops_and_steps_are_named_from_the_size_that_is_told() {
    let without = diagnosed(Vec::new());
    assert_eq!(names(&without), Vec::<&str>::new());
    for (name, seen, beyond, before) in [
        ("torque_saturation", Seen::Below, 0.99, 1.02),
        ("stop_angle", Seen::Below, 1.05, 0.8),
        ("pickoff_quantisation", Seen::Above, 1.1, 0.7),
    ] {
        let own = told(&without, name);
        let size = own.size.expect("a log that shows it");
        assert_eq!(own.seen, seen, "{name}");
        let [with, too_small] = [beyond, before].map(|share| diagnosed(vec![(name, vec![share * size])]));
        assert_eq!(names(&with), [name], "{name} of {beyond} times {size:.2e}");
        assert_eq!(names(&too_small), Vec::<&str>::new(), "{name} of {before} times {size:.2e}");
        // a log that shows it does not say that it could not have
        let least = told(&with, name).size.expect("a log that shows it");
        let past = if seen == Seen::Below { least - beyond * size } else { beyond * size - least };
        assert!(past > -0.01 * size.abs(), "{name}: {least:.2e} in a log of {:.2e}", beyond * size);
    }
    // the float of this motion stays far from a stop
    let case =
        Case { seed: 4, excitation: Excitation::RateTable, seconds: 15.0, effects: vec![], drift: 0.0, noise: 1.0 };
    let far = diagnose(&as_log(&simulate(&case)), &ModelFile::default());
    assert_eq!(told(&far, "stop_angle").size, None);
}
