//! `gimbal run`: a log, the paper's cases or a torque step through the model.

mod drive;
pub(crate) mod flight;
pub(crate) mod model;
mod output;
mod picture;
pub(crate) mod profile;
pub(crate) mod reference;
mod source;
mod summary;

use std::path::{Path, PathBuf};

use clap::{Parser, ValueEnum};
use gimbal_log::Column;
use gimbal_model_file::{ModelFile, effects};
use gimbal_plant::EffectError;
use gimbal_servo::{BuildError, Config, Fixed};
use serde_json::{Value, json};

use crate::exit::Failure;
use crate::report::{self, counted};
use drive::{Files, Finished};
use flight::Flight;
use model::{Initial, Kind, Model};
use profile::Profile;
use reference::Reference;
use source::{Mended, Source};
use summary::Summary;

/// A log through the model; without one, the paper's two 20 g cases.
#[derive(Debug, Parser)]
pub(crate) struct Args {
    /// Log; without one, the paper's two 20 g cases run
    log: Option<PathBuf>,
    #[command(flatten)]
    options: Options,
}

/// How to run.
#[derive(Debug, Clone, Parser)]
pub(crate) struct Options {
    /// Model file
    #[arg(long, value_name = "FILE.toml")]
    model: Option<PathBuf>,
    /// Number system of the flight law
    #[arg(long, value_enum, default_value_t = Number::F32)]
    number: Number,
    /// Run the reference plant instead of the flight law
    #[arg(long, conflicts_with = "number")]
    plant: bool,
    /// State before the first row
    #[arg(long, value_enum, default_value_t = Initial::Zero)]
    initial: Initial,
    /// 10 s of a torque on the gimbal, ended after `T_OFF_S`, instead of a log; no friction, no unbalance
    #[arg(long, value_name = "T[,T_OFF_S]", value_parser = Profile::torque, allow_hyphen_values = true)]
    disturbance_nm: Option<Profile>,
    /// Write the run; the paper's cases go to FILE-unbalance.csv and FILE-friction.csv
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Draw the run; the paper's cases go to FILE-unbalance.svg and FILE-friction.svg
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Print the summary as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Number {
    F32,
    Fixed,
}

impl Options {
    fn kind(&self) -> Kind {
        match (self.plant, self.number) {
            (true, _) => Kind::Plant,
            (false, Number::F32) => Kind::Float,
            (false, Number::Fixed) => Kind::Fixed,
        }
    }
}

/// Runs what the command line says.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let options = &args.options;
    let model = model_file(options.model.as_deref())?;
    if let Some(plot) = options.plot.as_deref().filter(|plot| plot.extension().is_none_or(|end| end != "svg")) {
        return Err(Failure::input(format!("{}: pictures are SVG; give a name that ends in .svg", plot.display())));
    }
    match (&args.log, options.disturbance_nm) {
        (Some(_), Some(_)) => Err(Failure::input("a log and --disturbance-nm exclude each other; give one of them")),
        (Some(log), None) => {
            for written in options.out.iter().chain(&options.plot) {
                Failure::unless_other_file(log, written)?;
            }
            let summary = run_log(log, &model, options)?;
            report::print(&summary.text(), options.json.then(|| summary.json()).as_ref())
        }
        (None, Some(step)) => {
            let summary = run_profile(step, &model, options, None)?;
            report::print(&summary.text(), options.json.then(|| summary.json()).as_ref())
        }
        (None, None) => run_paper(&model, options),
    }
}

/// Runs the paper's cases.
pub(crate) fn run_default(options: &Options) -> Result<(), Failure> {
    run(&Args { log: None, options: options.clone() })
}

fn run_paper(model: &ModelFile, options: &Options) -> Result<(), Failure> {
    let mut unbalance = run_profile(Profile::Unbalance, model, options, Some(Profile::Unbalance.name()))?;
    unbalance.published = unbalance.figure_7();
    let friction = run_profile(Profile::Friction, model, options, Some(Profile::Friction.name()))?;
    let text = format!("{}\n\n{}", unbalance.text(), friction.text());
    let json = options.json.then(|| {
        // The keys of a single run are those of the first case.
        let mut object: Value = unbalance.json();
        object["cases"] =
            json!({ Profile::Unbalance.name(): unbalance.json(), Profile::Friction.name(): friction.json() });
        object
    });
    report::print(&text, json.as_ref())
}

fn model_file(path: Option<&Path>) -> Result<ModelFile, Failure> {
    match path {
        None => Ok(ModelFile::default()),
        Some(path) => ModelFile::open(path).map_err(|error| Failure::Input(error.into())),
    }
}

fn run_profile(
    profile: Profile,
    model: &ModelFile,
    options: &Options,
    suffix: Option<&str>,
) -> Result<Summary, Failure> {
    let config = model::held(profile.config(&model.config));
    let mut files = Files::create(options, suffix, None)?;
    let finished =
        with_model(options, &config, model, |runs| drive::profile(runs, profile, config.period_s, &mut files))?;
    let title = profile.description();
    let notes = files.commit(&title)?;
    Ok(summary(title, options.kind(), finished, notes))
}

fn run_log(path: &Path, model: &ModelFile, options: &Options) -> Result<Summary, Failure> {
    let source = Source::open(path, options.out.is_some(), crosses(model, options))?;
    let config = Config { period_s: source.period_s, ..model.config };
    let mut notes = source.remarks.clone();
    notes.extend(left_out(model, options));
    notes.extend(cross_rate_note(&source, model, options));
    let mut files = Files::create(options, None, Some(&source))?;
    let finished = with_model(options, &config, model, |runs| drive::log(runs, &source, &mut files))?;
    notes.extend(told(&source.finish()));
    let title = path.display().to_string();
    notes.extend(files.commit(&title)?);
    Ok(summary(title, options.kind(), finished, notes))
}

/// Builds what is to run, and hands it over.
fn with_model(
    options: &Options,
    config: &Config,
    file: &ModelFile,
    run: impl FnOnce(&mut dyn Model) -> Result<Finished, Failure>,
) -> Result<Finished, Failure> {
    let refused = |error: BuildError| Failure::Input(file.locate(&error).into());
    let initial = options.initial;
    let (flown, _) = effects::flown(&file.effects);
    match options.kind() {
        Kind::Float => run(&mut Flight::<f32>::with_effects(config, &flown, initial).map_err(refused)?),
        Kind::Fixed => run(&mut Flight::<Fixed>::with_effects(config, &flown, initial).map_err(refused)?),
        Kind::Plant => {
            let plant = Reference::with_effects(config, &file.effects, initial);
            run(&mut plant.map_err(|error| match error {
                EffectError::Config(error) => refused(error),
                other => Failure::input(other.to_string()),
            })?)
        }
    }
}

fn summary(title: String, kind: Kind, finished: Finished, notes: Vec<String>) -> Summary {
    Summary { title, kind, totals: finished.totals, last: finished.last, notes, published: Vec::new() }
}

/// Effects of the model file that the flight law has not.
fn left_out(model: &ModelFile, options: &Options) -> Option<String> {
    let (_, names) = effects::flown(&model.effects);
    let told = !names.is_empty() && !matches!(options.kind(), Kind::Plant);
    told.then(|| format!("the flight law leaves out {}; --plant has it", names.join(", ")))
}

/// Whether the vehicle rate about x acts.
fn crosses(model: &ModelFile, options: &Options) -> bool {
    options.plant && model.effects.iter().any(|entry| entry.effect.name() == "cross_axis_coupling")
}

/// A rate about x that nothing takes, or that is missing.
fn cross_rate_note(source: &Source, model: &ModelFile, options: &Options) -> Option<String> {
    let note = match (crosses(model, options), source.columns.contains(&Column::CrossRate)) {
        (true, false) => "the log has no `cross_rate_radps`: cross_axis_coupling does nothing",
        (false, true) if options.plant => {
            "`cross_rate_radps` is not used: it acts through cross_axis_coupling, which the model has not"
        }
        _ => return None,
    };
    Some(note.to_owned())
}

/// What is worth a note about a log.
fn told(mended: &Mended) -> Vec<String> {
    let mut notes = Vec::new();
    if !mended.time.is_regular() {
        notes.push(mended.time.to_string());
    }
    if mended.filled_rows > 0 {
        notes.push(format!("{}: filled in along straight lines", counted(mended.filled_rows, "missing row")));
    }
    if mended.left_out_rows > 0 {
        notes
            .push(format!("{} less than half a period behind another: left out", counted(mended.left_out_rows, "row")));
    }
    if mended.missing_samples > 0 {
        notes.push(format!("{}: taken as the last one known", counted(mended.missing_samples, "missing sample")));
    }
    notes
}
