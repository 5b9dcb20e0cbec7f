//! Digest of the flight code's source: two builds with the same digest compute the same.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Everything that a flight computer runs but the board's own start-up and transport.
const SOURCES: [&str; 3] = ["../src", "../wire/src", "src"];

fn main() -> Result<(), Box<dyn Error>> {
    let mut files = Vec::new();
    for source in SOURCES {
        println!("cargo:rerun-if-changed={source}");
        collect(Path::new(source), &mut files)?;
    }
    files.sort();
    // 64-bit FNV-1a (Fowler, Noll, Vo).
    let mut digest = 0xCBF2_9CE4_8422_2325_u64;
    for file in files {
        let name = file.to_string_lossy().replace('\\', "/");
        for byte in name.bytes().chain(fs::read(&file)?) {
            digest = (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }
    let out = PathBuf::from(env::var("OUT_DIR")?).join("build.rs");
    let bytes = digest.to_be_bytes();
    let text =
        format!("/// Digest of the flight code's source.\npub const BUILD: u64 = u64::from_be_bytes({bytes:?});\n");
    fs::write(out, text)?;
    Ok(())
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    Ok(())
}
