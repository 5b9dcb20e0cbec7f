//! Diagnoses logs of plain axes: `axis MODEL.toml LOG... [--unseen LOG...]` prints what `gimbal gap` prints, and the
//! time it took.

use std::path::Path;
use std::time::Instant;

use gimbal_gap::axis::{AxisLog, diagnose, html, text};
use gimbal_model_file::AxisModel;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    let mut unseen = Vec::new();
    if let Some(place) = names.iter().position(|name| name == "--unseen") {
        unseen = names.split_off(place).split_off(1);
    }
    let Some((model, logs)) = names.split_first() else { return Err("a model file and logs are needed".into()) };
    let model = AxisModel::open(Path::new(model))?.ok_or("the model file has no table [axis]")?;
    for name in logs {
        let start = Instant::now();
        let others = unseen.iter().map(|name| Ok((name.clone(), AxisLog::open(Path::new(name), &model)?)));
        let others = others.collect::<Result<_, gimbal_gap::axis::AxisLogError>>()?;
        let diagnosis = diagnose(AxisLog::open(Path::new(name), &model)?, &model, others);
        println!("{name}\n{}", text(&diagnosis));
        println!("  [{:.2} s]\n", start.elapsed().as_secs_f64());
        if let Ok(folder) = std::env::var("PAGES") {
            let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
            std::fs::write(Path::new(&folder).join(format!("{stem}.html")), html(&diagnosis, name))?;
        }
    }
    Ok(())
}
