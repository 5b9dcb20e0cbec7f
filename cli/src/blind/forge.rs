//! `gimbal blind forge`.

use std::fs;
use std::path::{Path, PathBuf};

use gimbal_forge::corpus::Recipe;
use gimbal_forge::excitation::Rocket;
use gimbal_forge::write::{ForgeError, Watch};
use gimbal_forge::{Draw, Seed, seal};

use super::{bar, now_unix_s};
use crate::exit::Failure;
use crate::interrupt;

/// The real flight, where the project's measured logs are.
const ROCKET: &str = "../shared/real/rocket/irec_2023_easymega.csv";

/// Options of `gimbal blind forge`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder of the corpus; must not exist yet.
    dir: PathBuf,
    /// File for the key that opens the answers; outside the corpus.
    #[arg(long)]
    key: PathBuf,
    /// Number of logs: 150 for a check, 1500 for a release.
    #[arg(long, default_value_t = 150)]
    logs: usize,
    /// Least and largest length of a log [s].
    #[arg(long, num_args = 2, default_values_t = [20.0, 30.0], value_names = ["LEAST", "MOST"])]
    seconds: Vec<f64>,
    /// Seed that everybody may know; without it one is drawn and sealed with the answers.
    #[arg(long)]
    seed: Option<u64>,
    /// CSV export of a real rocket flight.
    #[arg(long, default_value = ROCKET)]
    rocket: PathBuf,
}

fn rocket(path: &Path) -> Result<Option<(Rocket, String)>, Failure> {
    let Ok(bytes) = fs::read(path) else {
        eprintln!("{}: not there; boosts stand in for the real flight", path.display());
        return Ok(None);
    };
    let flight = Rocket::parse(&String::from_utf8_lossy(&bytes))
        .map_err(|why| Failure::input(format!("{}: {why}", path.display())))?;
    Ok(Some((flight, seal::sha256(&bytes))))
}

/// Makes a corpus.
pub(super) fn forge(args: &Args) -> Result<(), Failure> {
    if args.dir.exists() {
        return Err(Failure::input(format!("{}: exists; a corpus is made once", args.dir.display())));
    }
    if args.key.exists() {
        return Err(Failure::input(format!("{}: exists; a key is never overwritten", args.key.display())));
    }
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    if absolute(&args.key).starts_with(absolute(&args.dir)) {
        return Err(Failure::input(format!("{}: the key must lie outside the corpus", args.key.display())));
    }
    let (least, most) = (args.seconds[0], args.seconds[1]);
    if !(5.0..=600.0).contains(&least) || !(least..=600.0).contains(&most) || args.logs == 0 || args.logs > 99_999 {
        return Err(Failure::input("--seconds must lie within 5 to 600, --logs within 1 to 99999"));
    }
    let flight = rocket(&args.rocket)?;
    let seed: Seed = args.seed.map_or_else(seal::fresh_seed, Draw::seed_of);
    let (rocket, rocket_sha256) = flight.unzip();
    let recipe = Recipe { logs: args.logs, seed, length_s: (least, most), rocket };
    let mut partial = args.dir.as_os_str().to_owned();
    partial.push(".partial");
    let partial = PathBuf::from(partial);
    let _ = fs::remove_dir_all(&partial);
    let bar = bar(args.logs as u64, "logs");
    let watch = Watch { done: &|| bar.inc(1), stop: &interrupt::raised };
    let made = gimbal_forge::write::write(&recipe, rocket_sha256, &partial, now_unix_s(), &watch);
    bar.finish_and_clear();
    let (published, key) = made.map_err(|error| {
        let _ = fs::remove_dir_all(&partial);
        match error {
            ForgeError::Interrupted => Failure::Interrupted,
            ForgeError::Refused(refusal) => Failure::Environment(refusal.into()),
        }
    })?;
    write_key(&args.key, &key)?;
    fs::rename(&partial, &args.dir).map_err(Failure::write(&args.dir))?;
    println!("{} logs in {}", args.logs, args.dir.display());
    println!("SHA-256 of the answers: {}", published.answers_sha256);
    Ok(())
}

fn write_key(path: &Path, key: &str) -> Result<(), Failure> {
    use std::io::Write;
    let mut options = fs::OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let mut file = options.open(path).map_err(Failure::write(path))?;
    file.write_all(key.as_bytes()).map_err(Failure::write(path))
}
