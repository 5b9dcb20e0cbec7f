//! Friction where an axis slips steadily: there it must brake.

use super::motion::Motion;
use super::search::Candidate;

/// Rows at which friction is looked at.
const SLIP_ROWS: usize = 400;
/// Slip is steady where its direction is smoothed by no more than this.
const STEADY: f64 = 0.97;
/// Share of the rows of slip at which fitted friction may drive.
const MAY_DRIVE: f64 = 0.02;

/// Rows of steady slip, and what each column adds to friction there, along the motion; other columns stand empty.
#[derive(Debug, Default)]
pub(super) struct Slip {
    /// Rows of the grid, and the direction there.
    pub(super) rows: Vec<(usize, f64)>,
    /// Friction of the nominal model.
    pub(super) nominal: Vec<f64>,
    pub(super) columns: Vec<Vec<f64>>,
}

impl Slip {
    /// Friction at rows of steady slip, away from reversals and from what smoothing reaches of them: of the nominal model,
    /// and of the columns of friction.
    pub(super) fn new(motion: &Motion, parameters: [f64; 3], columns: &[Vec<f64>], candidates: &[Candidate]) -> Self {
        let mut friction = vec![false; columns.len()];
        friction[1..3].fill(true);
        for candidate in candidates.iter().filter(|candidate| candidate.shape.brakes()) {
            candidate.columns.iter().for_each(|&column| friction[column] = true);
        }
        let thin = (motion.rows.len() / SLIP_ROWS).max(1);
        let steady = |place: &usize| columns[2][*place].abs() > STEADY;
        let rows = (0..motion.rows.len()).step_by(thin).filter(steady);
        let mut slip =
            Self { rows: rows.map(|place| (place, columns[2][place].signum())).collect(), ..Self::default() };
        let [viscous, coulomb] = [slip.along(&columns[1]), slip.along(&columns[2])];
        slip.nominal = viscous.iter().zip(&coulomb).map(|(v, s)| parameters[1] * v + parameters[2] * s).collect();
        slip.columns = columns
            .iter()
            .zip(&friction)
            .map(|(column, friction)| if *friction { slip.along(column) } else { Vec::new() })
            .collect();
        slip
    }

    /// A column along the motion.
    pub(super) fn along(&self, column: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|&(place, direction)| column[place] * direction).collect()
    }

    /// Whether friction brakes. What drives is the loop's own answer, for its effort falls with the rate:
    ///
    /// ```text
    /// friction(q, v, t) sgn v >= 0
    /// ```
    pub(super) fn brakes(&self, columns: &[usize], amplitudes: &[f64]) -> bool {
        let mut friction = self.nominal.clone();
        for (&column, amplitude) in columns.iter().zip(amplitudes) {
            friction.iter_mut().zip(&self.columns[column]).for_each(|(sum, value)| *sum += amplitude * value);
        }
        let drives = friction.iter().filter(|along| **along < 0.0).count();
        drives as f64 <= MAY_DRIVE * friction.len() as f64
    }
}
