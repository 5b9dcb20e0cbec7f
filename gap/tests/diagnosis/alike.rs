//! Values and effects that nearly stand for each other.

use gimbal_gap::diagnose;
use gimbal_gap::fit::{Effort, Problem, Set, refine};
use gimbal_gap::judge::{Spread, Verdict};
use gimbal_gap::record::Record;
use gimbal_model_file::ModelFile;

use crate::corpus::Excitation;
use crate::{log_with, names};

#[test]
fn a_level_of_friction_far_from_nominal_is_not_taken_for_what_it_is_like_at_one_load() {
    for level in [0.55, 1.7] {
        let diagnosis =
            diagnose(&log_with(Excitation::RateTable, &[("friction_level", vec![level])]), &ModelFile::default());
        let found = &diagnosis.decision.as_ref().expect("a decision").found;
        assert_eq!(names(&diagnosis), ["friction_level"], "{level}");
        // the nominal level is off by its tolerance at most
        assert!(((1.0 + found[0].values[0]) / (1.0 + level) - 1.0).abs() < 0.15, "{level}: {found:?}");
    }
}

#[test]
fn how_well_a_value_is_known_does_not_hang_on_the_steps_of_the_sensitivities() {
    let (log, model) = (log_with(Excitation::Manoeuvre, &[("loop_delay", vec![2.4e-4])]), ModelFile::default());
    let record = Record::new(&log, &model.config);
    let mut problem = Problem::new(&record, &model);
    let delay = problem.candidates.iter().position(|own| own.effect == "loop_delay").expect("a candidate");
    let fit = refine(&problem, &Set(vec![delay]), &[vec![2.4e-4]], None, Effort::Thorough);
    let error_s = |problem: &Problem| Spread::new(problem, &fit).expect("a spread").errors[0][0];
    let coarse_s = error_s(&problem);
    problem.nuisances.iter_mut().for_each(|own| own.step *= 0.1);
    // a lag, a delay and a pure delay nearly stand for each other
    assert!((coarse_s / error_s(&problem) - 1.0).abs() < 0.1, "{coarse_s:e} {:e}", error_s(&problem));
}

/// Under a large effect three are nearly alike that each take away what is left: nothing is left unexplained, and the one that is there
/// is named, as beyond its tolerance it is no formulation of the large one.
#[test]
fn what_any_of_a_few_effects_takes_away_is_not_left_beside_a_large_one() {
    let effects = [("torque_ripple", vec![4e-3, 8.0, 0.4]), ("pickoff_scale", vec![0.12])];
    let diagnosis = diagnose(&log_with(Excitation::RateTable, &effects), &ModelFile::default());
    let decision = diagnosis.decision.as_ref().expect("a decision");
    assert_eq!(decision.verdict, Verdict::Explained, "{:?}", decision.strangers.first());
    assert_eq!(names(&diagnosis), ["torque_ripple", "pickoff_scale"], "{:?}", decision.alternatives);
}
