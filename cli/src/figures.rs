//! `gimbal figures`: the paper redrawn through the flight code and the plant, and how close each of its numbers is.

mod elasticity;
mod facts;
mod growth;
mod load;
mod misprints;
mod page;
mod rate_table;
mod sheet;
mod slips;
mod time;
mod trace;

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Parser;
use gimbal_log::AtomicFile;
use gimbal_servo::{BuildError, Config};
use serde_json::json;

use crate::exit::Failure;
use crate::{interrupt, report};
use sheet::Sheet;

/// The paper's figures through the flight code and the plant, and a table of its facts.
#[derive(Debug, Parser)]
pub(crate) struct Args {
    /// Folder for figure-*.svg, .png, .csv and figures.html; made if it is not there
    #[arg(long, value_name = "DIR", default_value = "figures")]
    out: PathBuf,
    /// Print the tables of docs/misprints.md instead: elasticities, slips, what would explain the open difference
    #[arg(long)]
    misprints: bool,
    /// Print the table of facts as JSON
    #[arg(long, conflicts_with = "misprints")]
    json: bool,
}

/// A way to make one figure, or two.
type Maker = fn(&Config) -> Result<Vec<Sheet>, Failure>;

const MAKERS: [Maker; 5] = [time::steps, rate_table::sheets, load::sheets, time::accelerations, growth::sheets];

/// Runs what the command line says.
pub(crate) fn figures(args: &Args) -> Result<(), Failure> {
    if args.misprints {
        return report::print(&misprints::tables().map_err(refused)?, None);
    }
    std::fs::create_dir_all(&args.out).map_err(Failure::write(&args.out))?;
    let config = Config::consistent();
    let mut sheets = Vec::new();
    for maker in MAKERS {
        interrupt::check()?;
        sheets.extend(maker(&config)?);
    }
    sheets.sort_by_key(|sheet| sheet.order);
    let facts = facts::facts().map_err(refused)?;
    for sheet in &sheets {
        let path = |extension: &str| args.out.join(format!("figure-{}.{extension}", sheet.number));
        write(&path("svg"), sheet.svg.as_bytes())?;
        write(&path("png"), &sheet.png)?;
        write(&path("csv"), sheet.csv.as_bytes())?;
    }
    let page = args.out.join("figures.html");
    write(&page, page::html(&sheets, &facts).as_bytes())?;
    let text = format!("{}\n{}written: {}", facts::text(&facts), sheet::differences(&sheets), page.display());
    let figures: Vec<_> = sheets.iter().map(Sheet::json).collect();
    let object = args.json.then(|| json!({ "facts": facts::json(&facts), "figures": figures, "page": page }));
    report::print(&text, object.as_ref())
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let fail = || Failure::write(path);
    let mut file = AtomicFile::create(path).map_err(fail())?;
    file.write_all(bytes).map_err(fail())?;
    file.commit().map_err(fail())
}

/// A preset that cannot be built would be this program's mistake.
fn refused(error: BuildError) -> Failure {
    Failure::Input(anyhow::Error::msg(error.to_string()))
}
