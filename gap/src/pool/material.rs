//! One log made ready to be fitted beside others: under the noise of its own diagnosis, with sensitivities taken where
//! that ended.

use gimbal_model_file::ModelFile;

use crate::diagnose::{Asked, Diagnosis};
use crate::fit::{Ground, Problem, rebase};

/// A log among others.
pub(super) struct Material<'a> {
    /// Its place among the diagnoses.
    pub(super) log: usize,
    pub(super) problem: Problem<'a>,
    pub(super) asked: &'a Asked,
}

impl<'a> Material<'a> {
    /// None of a log that does not serve.
    pub(super) fn new(log: usize, diagnosis: &'a Diagnosis, model: &ModelFile) -> Option<Self> {
        let (asked, fit) = (diagnosis.asked.as_ref()?, diagnosis.fit.as_ref()?);
        let mut problem = Ground::new(&diagnosis.record, model).problem(asked.known.clone());
        rebase(&mut problem, fit);
        Some(Self { log, problem, asked })
    }
}
