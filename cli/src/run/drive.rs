//! Rows into a model, and what it gives into files.

use std::path::{Path, PathBuf};

use super::Options;
use super::model::{Model, Sample, Totals};
use super::output::Output;
use super::picture::Picture;
use super::profile::Profile;
use super::source::Source;
use crate::exit::Failure;
use crate::interrupt;

/// A run that is over.
pub(super) struct Finished {
    pub(super) totals: Totals,
    pub(super) last: Sample,
}

/// The files that a run is written to, if any.
pub(super) struct Files {
    output: Option<Output>,
    picture: Option<(PathBuf, Picture)>,
}

impl Files {
    /// Starts the files that the options ask for.
    pub(super) fn create(options: &Options, suffix: Option<&str>, source: Option<&Source>) -> Result<Self, Failure> {
        let named = |path: &Path| suffix.map_or_else(|| path.to_owned(), |suffix| with_suffix(path, suffix));
        let (columns, extras) = source.map_or((&[][..], &[][..]), |source| (&source.columns, &source.extra_names));
        let output = options.out.as_deref().map(|path| Output::create(&named(path), columns, extras)).transpose()?;
        let picture = options.plot.as_deref().map(|path| (named(path), Picture::new()));
        Ok(Self { output, picture })
    }

    fn wanted(&self) -> bool {
        self.output.is_some() || self.picture.is_some()
    }

    /// Lets the files appear, and names them.
    pub(super) fn commit(self, title: &str) -> Result<Vec<String>, Failure> {
        interrupt::check()?;
        let mut notes = Vec::new();
        if let Some((path, picture)) = self.picture {
            picture.write(&path, title)?;
            notes.push(format!("drawn: {}", path.display()));
        }
        if let Some(output) = self.output {
            notes.push(format!("written: {}", output.commit()?.display()));
        }
        Ok(notes)
    }
}

/// `run.csv` and `friction` give `run-friction.csv`.
fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().map(|extension| format!(".{}", extension.to_string_lossy())).unwrap_or_default();
    path.with_file_name(format!("{stem}-{suffix}{extension}"))
}

/// Drives a profile through a model.
pub(super) fn profile(
    model: &mut dyn Model,
    profile: Profile,
    period_s: f64,
    files: &mut Files,
) -> Result<Finished, Failure> {
    for k in 0..Profile::len(period_s) {
        let input = profile.row(k, period_s);
        model.step(&input.into());
        if files.wanted() {
            let (time_s, sample) = (f64::from(k) * period_s, model.sample());
            if let Some(output) = &mut files.output {
                output.row(time_s, &input, &sample, None)?;
            }
            if let Some((_, picture)) = &mut files.picture {
                picture.push(time_s, &input, &sample);
            }
        }
        if k % 1024 == 0 {
            interrupt::check()?;
        }
    }
    Ok(Finished { totals: model.totals(), last: model.sample() })
}

/// Drives a log through a model.
pub(super) fn log(model: &mut dyn Model, source: &Source, files: &mut Files) -> Result<Finished, Failure> {
    while let Some(portion) = source.next()? {
        interrupt::check()?;
        if files.wanted() {
            for (index, (drive, row)) in portion.inputs.iter().zip(&portion.rows).enumerate() {
                model.step(drive);
                let (time_s, sample) = (portion.times_s[index], model.sample());
                if let Some(output) = &mut files.output {
                    let from = row.map(|row| (&portion.batch, row as usize));
                    output.row(time_s, &drive.input, &sample, from)?;
                }
                if let Some((_, picture)) = &mut files.picture {
                    picture.push(time_s, &drive.input, &sample);
                }
            }
        } else {
            model.steps(&portion.inputs);
        }
        source.give_back(portion);
    }
    interrupt::check()?;
    Ok(Finished { totals: model.totals(), last: model.sample() })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::with_suffix;

    #[test]
    fn contract_a_case_stands_before_the_extension() {
        assert_eq!(with_suffix(Path::new("a.b/run.csv"), "friction"), Path::new("a.b/run-friction.csv"));
        assert_eq!(with_suffix(Path::new("run"), "friction"), Path::new("run-friction"));
    }
}
