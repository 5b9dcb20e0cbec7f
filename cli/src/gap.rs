//! `gimbal gap`: where the gap between a model and a log lies, which effect causes it, how far it shrinks.

use std::cell::RefCell;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Parser;
use gimbal_gap::axis::{self, AxisLog};
use gimbal_gap::close;
use gimbal_gap::report as told;
use gimbal_log::{AtomicFile, Log, Needs};
use gimbal_model_file::{AxisModel, ModelFile, known_good};
use serde_json::{Value, json};

use crate::exit::Failure;
use crate::interrupt;
use crate::progress;
use crate::report;

/// Diagnoses the gap between a model and logs.
#[derive(Debug, Parser)]
pub(crate) struct Args {
    /// Logs; several of one platform are diagnosed each by itself, then together
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Model file
    #[arg(long, value_name = "FILE.toml")]
    model: Option<PathBuf>,
    /// Folder for gap.json and gap.html; with several logs, a folder in it for each, and pooled.json and pooled.html
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Part that is known to be good, such as `torque_sensor`, or effect that is none: as `[known_good]` in the model file
    #[arg(long, value_name = "PART", value_delimiter = ',')]
    trust: Vec<String>,
    /// Write the model with what was found in it
    #[arg(long, value_name = "FILE.toml")]
    write_model: Option<PathBuf>,
    /// Log that is not fitted: what the diagnosis of each LOG leaves of it is told (plain axes alone)
    #[arg(long, value_name = "LOG")]
    unseen: Vec<PathBuf>,
    /// Print the report as JSON; with several logs, one object with all
    #[arg(long)]
    json: bool,
}

/// Diagnoses what the command line says.
pub(crate) fn gap(args: &Args) -> Result<(), Failure> {
    if let Some(path) = &args.model
        && let Some(model) = AxisModel::open(path).map_err(|error| Failure::Input(error.into()))?
    {
        if !args.trust.is_empty() || args.write_model.is_some() {
            return Err(Failure::input(
                "--trust, --write-model: not for a plain axis; what is known to be good there stands in its model file, `known_good` of [axis]",
            ));
        }
        return bare_axis(args, &model, &path.display().to_string());
    }
    if !args.unseen.is_empty() {
        return Err(Failure::input("--unseen: needs the model of a plain axis, a file with the table [axis]"));
    }
    let mut model = match &args.model {
        None => ModelFile::default(),
        Some(path) => ModelFile::open(path).map_err(|error| Failure::Input(error.into()))?,
    };
    for name in &args.trust {
        let part = known_good::part(name).map_err(|message| Failure::input(format!("--trust: {message}")))?;
        model.known_good.push(part);
    }
    if let Some(written) = &args.write_model {
        if args.logs.len() > 1 {
            return Err(Failure::input("--write-model: takes one log"));
        }
        for read in args.logs.iter().chain(&args.model) {
            Failure::unless_other_file(read, written)?;
        }
    }
    let model = model;
    let model_name = args.model.as_deref().map_or_else(|| "consistent".to_owned(), |path| path.display().to_string());
    let kept = RefCell::new(Vec::new());
    let told = reported(args, |path, name| {
        let diagnosis = gimbal_gap::diagnose(&Log::open(path, Needs::Diagnosis)?, &model);
        let mut text = told::text(&diagnosis);
        if let Some(written) = &args.write_model {
            let remark = match close::corrected(&diagnosis, &model) {
                Ok(corrected) => {
                    self::write(written, &corrected)?;
                    format!("\nwritten: {}", written.display())
                }
                Err(why) => format!("\nnot written: {}; {why}", written.display()),
            };
            text.push_str(&remark);
        }
        let told = Told { json: told::json(&diagnosis, name, &model_name), page: told::html(&diagnosis, name), text };
        if args.logs.len() > 1 {
            kept.borrow_mut().push(diagnosis);
        }
        Ok(told)
    })?;
    let diagnoses = kept.into_inner();
    if diagnoses.is_empty() {
        return printed(args, &told.texts, &one_or_list(told.reports));
    }
    let names: Vec<String> = args.logs.iter().map(|path| path.display().to_string()).collect();
    let bar = progress::steps("logs together");
    let pool = gimbal_gap::pool_step_by_step(&diagnoses, &model, || bar.inc(1));
    bar.finish_and_clear();
    interrupt::check()?;
    let pooled = pool.json(&names);
    if let Some(out) = &args.out {
        let text = format!("{pooled:#}\n");
        write(&out.join("pooled.json"), &text)?;
        write(&out.join("pooled.html"), &told::pooled(&pool, &names))?;
    }
    let texts: Vec<String> = told.texts.into_iter().chain([pool.text(&names)]).collect();
    printed(args, &texts, &json!({ "schema": "gimbal-gap-pool/1", "pooled": pooled, "logs": told.reports }))
}

fn one_or_list(mut reports: Vec<Value>) -> Value {
    if reports.len() == 1 { reports.remove(0) } else { Value::Array(reports) }
}

fn printed(args: &Args, texts: &[String], json: &Value) -> Result<(), Failure> {
    report::print(&texts.join("\n\n"), args.json.then_some(json))
}

/// Diagnoses a plain axis, one without a gyro.
fn bare_axis(args: &Args, model: &AxisModel, model_name: &str) -> Result<(), Failure> {
    let open = |path: &PathBuf| AxisLog::open(path, model).map_err(|error| Failure::Input(error.into()));
    let told = reported(args, |path, name| {
        let unseen = args.unseen.iter().map(|path| Ok((path.display().to_string(), open(path)?)));
        let diagnosis = axis::diagnose(open(path)?, model, unseen.collect::<Result<_, Failure>>()?);
        Ok(Told {
            json: axis::json(&diagnosis, name, model_name),
            page: axis::html(&diagnosis, name),
            text: axis::text(&diagnosis),
        })
    })?;
    printed(args, &told.texts, &one_or_list(told.reports))
}

/// What is told of one log.
struct Told {
    json: Value,
    page: String,
    text: String,
}

/// What is told of all.
struct All {
    texts: Vec<String>,
    reports: Vec<Value>,
}

/// Log after log, by its path and name; reports written as they come.
fn reported(args: &Args, diagnosed: impl Fn(&PathBuf, &str) -> Result<Told, Failure>) -> Result<All, Failure> {
    let mut texts = Vec::new();
    let mut reports: Vec<Value> = Vec::new();
    let bar = progress::steps("logs");
    for path in &args.logs {
        interrupt::check()?;
        let name = path.display().to_string();
        let Told { json, page, text } = diagnosed(path, &name)?;
        if let Some(out) = &args.out {
            let folder =
                if args.logs.len() == 1 { out.clone() } else { out.join(path.file_stem().unwrap_or_default()) };
            std::fs::create_dir_all(&folder).map_err(Failure::write(&folder))?;
            write(&folder.join("gap.json"), &format!("{json:#}\n"))?;
            write(&folder.join("gap.html"), &page)?;
        }
        texts.push(if args.logs.len() == 1 { text } else { format!("{name}\n{text}") });
        reports.push(json);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(All { texts, reports })
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let mut file = AtomicFile::create(path).map_err(Failure::write(path))?;
    file.write_all(text.as_bytes()).map_err(Failure::write(path))?;
    file.commit().map_err(Failure::write(path))
}
