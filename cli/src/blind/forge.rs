//! `gimbal blind forge`.

use std::fs;
use std::path::{Path, PathBuf};

use gimbal_forge::corpus::Recipe;
use gimbal_forge::excitation::Rocket;
use gimbal_forge::write::{Access, ForgeError, Watch};
use gimbal_forge::{Draw, Seed, freeze, seal};

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
    #[arg(long, required_unless_present = "open")]
    key: Option<PathBuf>,
    /// Development set: answers in clear beside the logs (`NNNNN.answer.json`); nothing that is scored on it counts.
    #[arg(long, conflicts_with = "key")]
    open: bool,
    /// Record of the diagnosis (`gimbal blind freeze`), committed to git: the seed is drawn after it.
    #[arg(long, required_unless_present_any = ["open", "seed"], conflicts_with_all = ["open", "seed"])]
    freeze: Option<PathBuf>,
    /// Number of logs: 150 for a check, 1500 for a release.
    #[arg(long, default_value_t = 150)]
    logs: usize,
    /// Least and largest length of a log [s].
    #[arg(long, num_args = 2, default_values_t = [20.0, 30.0], value_names = ["LEAST", "MOST"])]
    seconds: Vec<f64>,
    /// Seed that everybody may know: a check or a development set, never a blind score.
    #[arg(long)]
    seed: Option<u64>,
    /// Shares of nothing, one, two, three effects and one beyond the table [percent]; of development sets alone.
    #[arg(long, num_args = 5, requires = "open", value_names = ["NOTHING", "ONE", "TWO", "THREE", "BEYOND"])]
    shares: Option<Vec<usize>>,
    /// Least and largest size over the detectable one; of development sets alone.
    #[arg(long, num_args = 2, requires = "open", value_names = ["LEAST", "MOST"])]
    multiples: Option<Vec<f64>>,
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

fn check_key(key: &Path, dir: &Path) -> Result<(), Failure> {
    if key.exists() {
        return Err(Failure::input(format!("{}: exists; a key is never overwritten", key.display())));
    }
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    if absolute(key).starts_with(absolute(dir)) {
        return Err(Failure::input(format!("{}: the key must lie outside the corpus", key.display())));
    }
    Ok(())
}

/// The seed, and who may read the answers. Seeds of development sets are other ones than those of scoring corpora.
fn seed(args: &Args, record: Option<&[u8]>) -> (Seed, Access) {
    if args.open {
        let seed = args.seed.map_or_else(seal::fresh_bytes, seal::development_seed);
        return (seed, Access::Open);
    }
    let Some(record) = record else {
        let seed = args.seed.map_or_else(seal::fresh_bytes, Draw::seed_of);
        return (seed, Access::Sealed { freeze_sha256: None, nonce: None });
    };
    let (freeze_sha256, nonce) = (seal::sha256(record), seal::hexadecimal(&seal::fresh_bytes()));
    let seed = freeze::seed(&freeze_sha256, &nonce);
    (seed, Access::Sealed { freeze_sha256: Some(freeze_sha256), nonce: Some(nonce) })
}

/// The mixture of a development set.
fn mix(args: &Args, recipe: &mut Recipe) -> Result<(), Failure> {
    if let Some(shares) = &args.shares {
        recipe.shares.copy_from_slice(shares);
        if shares.iter().sum::<usize>() != 100 {
            return Err(Failure::input("--shares: five percentages that add up to 100"));
        }
    }
    if let Some(multiples) = &args.multiples {
        recipe.multiples = (multiples[0], multiples[1]);
        if !(0.1..=100.0).contains(&multiples[0]) || !(multiples[0]..=100.0).contains(&multiples[1]) {
            return Err(Failure::input("--multiples: rising, within 0.1 to 100"));
        }
    }
    Ok(())
}

/// Makes a corpus.
pub(super) fn forge(args: &Args) -> Result<(), Failure> {
    if args.dir.exists() {
        return Err(Failure::input(format!("{}: exists; a corpus is made once", args.dir.display())));
    }
    if let Some(key) = &args.key {
        check_key(key, &args.dir)?;
    }
    let (least, most) = (args.seconds[0], args.seconds[1]);
    if !(5.0..=600.0).contains(&least) || !(least..=600.0).contains(&most) || args.logs == 0 || args.logs > 99_999 {
        return Err(Failure::input("--seconds must lie within 5 to 600, --logs within 1 to 99999"));
    }
    let flight = rocket(&args.rocket)?;
    let (rocket, rocket_sha256) = flight.unzip();
    let record = args.freeze.as_deref().map(super::freeze::committed).transpose()?;
    let (seed, access) = seed(args, record.as_deref());
    let mut recipe = Recipe::scoring(args.logs, seed, (least, most), rocket);
    mix(args, &mut recipe)?;
    let mut partial = args.dir.as_os_str().to_owned();
    partial.push(".partial");
    let partial = PathBuf::from(partial);
    let _ = fs::remove_dir_all(&partial);
    let bar = bar(args.logs as u64, "logs");
    let watch = Watch { done: &|| bar.inc(1), stop: &interrupt::raised };
    let made = gimbal_forge::write::write(&recipe, rocket_sha256, &access, &partial, now_unix_s(), &watch);
    bar.finish_and_clear();
    let (published, key) = made.map_err(|error| {
        let _ = fs::remove_dir_all(&partial);
        match error {
            ForgeError::Interrupted => Failure::Interrupted,
            ForgeError::Refused(refusal) => Failure::Environment(refusal.into()),
        }
    })?;
    if let Some(record) = &record {
        let path = partial.join("freeze.json");
        fs::write(&path, record).map_err(Failure::write(&path))?;
    }
    if let (Some(path), Some(key)) = (&args.key, &key) {
        write_key(path, key)?;
    }
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
