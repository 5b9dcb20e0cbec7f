//! `gimbal sweep`: parameters over ranges and tolerances, many platforms through the flight code.
//!
//! Runs are numbered; what run k is follows from k and the plan alone, so that neither threads nor interruptions change
//! a bit of the result. Finished runs are appended in order to a file beside the result that takes its name at the end.

mod answer;
mod lanes;
pub(crate) mod margin;
pub(crate) mod parameter;
mod parquet;
mod picture;
mod plan;
mod processor;
mod record;
mod told;
pub(crate) mod trial;

use std::fmt::Write;
use std::path::PathBuf;

use clap::Parser;
use gimbal_model_file::ModelFile;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use crate::exit::Failure;
use crate::{interrupt, report};
use answer::Answer;
use lanes::LANES;
use plan::{Plan, Range, Run};
use record::Record;
use trial::Case;

/// At how many g does the platform saturate, and which part's tolerance decides that.
#[derive(Debug, Parser)]
pub(crate) struct Args {
    /// Model file; its table of tolerances is what --monte-carlo draws from
    #[arg(long, value_name = "FILE.toml")]
    model: Option<PathBuf>,
    /// What disturbs the platform
    #[arg(long, value_enum, default_value_t = Case::Both)]
    case: Case,
    /// Acceleration of the runs whose peaks and velocity error are given [g]
    #[arg(long, value_name = "G", default_value_t = 20.0)]
    accel_g: f64,
    /// A parameter over a range, by its name in the model file or its letter; several make a grid
    #[arg(long, value_name = "NAME=FROM..TO[:COUNT]", value_parser = Range::parse)]
    vary: Vec<Range>,
    /// So many platforms spread evenly over all ranges at once: a Latin hypercube
    #[arg(long, value_name = "RUNS", requires = "vary")]
    latin: Option<u64>,
    /// So many platforms with every parameter drawn from its tolerance; 2000 where nothing is said
    #[arg(long, value_name = "RUNS", conflicts_with_all = ["vary", "latin"])]
    monte_carlo: Option<u64>,
    /// Another draw
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// One row a run, CSV or Parquet by the name; an interrupted sweep goes on from where it was
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draw it: a heat map of two ranges, a line of one, percentiles of draws; .svg or .png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Threads; all processors where nothing is said
    #[arg(long)]
    threads: Option<usize>,
    /// Print the answer as JSON
    #[arg(long)]
    json: bool,
}

/// Runs what the command line says.
pub(crate) fn sweep(args: &Args) -> Result<(), Failure> {
    let model = match &args.model {
        None => ModelFile::default(),
        Some(path) => ModelFile::open(path).map_err(|error| Failure::Input(error.into()))?,
    };
    model.without_effects("`gimbal sweep`").map_err(|error| Failure::Input(error.into()))?;
    let most_g = model.config.range.radial_accel_mps2 / gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
    if !(args.accel_g > 0.0 && args.accel_g <= most_g) {
        return Err(Failure::input(format!(
            "--accel-g {}: write an acceleration above 0 and up to {most_g:.1} g, the model's range",
            args.accel_g
        )));
    }
    model.config.build::<f32>().map_err(|error| Failure::Input(model.locate(&error).into()))?;
    let plan = Plan::new(args, &model)?;
    let mut answer = Answer::new(&plan);
    let mut record = args.out.as_deref().map(|out| Record::open(out, &plan)).transpose()?;
    if let Some(record) = &record {
        for row in record.kept()? {
            answer.take(&row.map_err(|error| Failure::Environment(error.into()))?);
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads.unwrap_or(0)).build();
    let pool = pool.map_err(|error| Failure::Environment(error.into()))?;
    let threads = pool.current_num_threads() as u64;
    let bar = bar(plan.runs(), answer.runs());
    while answer.runs() < plan.runs() {
        if interrupt::raised() {
            if record.is_some() {
                eprintln!("{} of {} runs are kept; the same call goes on from there", answer.runs(), plan.runs());
            }
            return Err(Failure::Interrupted);
        }
        let rows: Vec<Vec<String>> =
            pool.install(|| (0..threads).into_par_iter().map(|part| rows(&plan, answer.runs(), part)).collect());
        let rows = rows.concat();
        if let Some(record) = &mut record {
            record.append(&rows)?;
        }
        for row in &rows {
            answer.take(row.trim_end());
        }
        bar.set_position(answer.runs());
    }
    bar.finish_and_clear();
    if let Some(path) = &args.plot {
        picture::draw(path, &plan, &answer)?;
    }
    let mut text = answer.text(&plan);
    if let Some(record) = record {
        let _ = write!(text, "\nwritten: {}", record.commit()?.display());
    }
    report::print(&text, args.json.then(|| answer.json(&plan)).as_ref())
}

/// Rows of the runs of one thread, some of those behind `done`.
fn rows(plan: &Plan, done: u64, part: u64) -> Vec<String> {
    let from = (done + part * LANES as u64).min(plan.runs());
    let to = (from + LANES as u64).min(plan.runs());
    plan.run(from..to).iter().map(Run::csv).collect()
}

fn bar(runs: u64, done: u64) -> ProgressBar {
    use std::io::IsTerminal;
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(runs).with_position(done);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos} of {len} runs  {per_sec}  {eta} left") {
        bar.set_style(style);
    }
    bar.reset_eta();
    bar
}
