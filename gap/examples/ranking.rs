//! Every set that was looked at for one simulated log, best first:
//! `cargo run --release -p gimbal-gap --example ranking -- SECONDS SEED SIZE EXCITATION EFFECT`.

#[path = "corpus/mod.rs"]
pub mod corpus;

use corpus::{Case, Excitation, as_log};
use gimbal_gap::fit::{Problem, null, search};
use gimbal_gap::record::Record;
use gimbal_log::{Log, Needs};
use gimbal_model_file::ModelFile;
use gimbal_plant::Effect;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (log, model) = if args.len() <= 2 {
        let log = Log::open(std::path::Path::new(&args[0]), Needs::Diagnosis).expect("log");
        (log, ModelFile::open(std::path::Path::new(&args[1])).expect("model"))
    } else {
        let effect = Effect::from_name(&args[4]);
        let size: f64 = args[2].parse().expect("size");
        let mut values = effect.map(Effect::typical).unwrap_or_default();
        for value in values.iter_mut().take(effect.map_or(0, Effect::sizes)) {
            *value *= size;
        }
        let case = Case {
            seed: args[1].parse().expect("seed"),
            excitation: Excitation::ALL[args[3].parse::<usize>().expect("excitation")],
            seconds: args[0].parse().expect("seconds"),
            effects: effect.map(|effect| (effect.name(), values)).into_iter().collect(),
            drift: 1.0,
            noise: 1.0,
        };
        (as_log(&corpus::simulate(&case)), ModelFile::default())
    };
    let mut record = Record::new(&log, &model.config);
    record.quieten(&gimbal_gap::library::platform(&model));
    println!("rate noise {:.2e} filtered {}", record.rate_noise.rms_radps, record.rate_noise.pass.len() > 1);
    let mut problem = Problem::new(&record, &model);
    let nominal = null(&mut problem, None);
    let search = search(&mut problem, nominal);
    let count = problem.whitener.count() as f64;
    println!("noise {:?} count {count} null square/count {:.4}", problem.noise, search.null.square / count);
    let channels = problem.record.channels.len();
    let rows = record.rows();
    for from in (0..rows).step_by(1000) {
        let to = (from + 1000).min(rows);
        let power: f64 = search.null.residual[from * channels..to * channels].iter().map(|v| v * v).sum();
        let peak = (from..to).map(|k| record.inputs.rate_radps[k].abs()).fold(0.0, f64::max);
        let accel = (from..to)
            .map(|k| record.inputs.accel_mps2[0][k].hypot(record.inputs.accel_mps2[1][k]))
            .fold(0.0, f64::max);
        let theta = (from..to).map(|k| record.channels[0].values[k].abs()).fold(0.0, f64::max);
        let p = power / ((to - from) * channels) as f64;
        if p > 1.3 {
            println!(
                "  {from}: power {p:.2} rate {peak:.3} accel {accel:.1} theta {theta:.2e} valid {}",
                (from..to).filter(|&k| problem.whitener.valid[k]).count()
            );
        }
    }
    println!("{:?}", problem.whitener.noise);
    for fit in std::iter::once(&search.null).chain(search.fits.iter().take(14)) {
        println!(
            "{:40} excess {:9.1} gain {:9.1} prior {:7.2} volume {:8.2} evidence {:9.2}",
            fit.effects.join("+"),
            fit.square - count,
            0.5 * (search.null.square - fit.square),
            fit.prior,
            fit.volume,
            fit.evidence(1.0) - search.null.evidence(1.0),
        );
        for (values, errors) in fit.values.iter().zip(&fit.errors) {
            let each: Vec<String> = values.iter().zip(errors).map(|(v, e)| format!("{v:.4e} +- {e:.1e}")).collect();
            println!("      {}", each.join("  "));
        }
        let shifts: Vec<String> = problem
            .nuisances
            .iter()
            .zip(&fit.shifts)
            .filter(|(nuisance, shift)| shift.abs() > 1.0 * nuisance.sigma)
            .map(|(nuisance, shift)| format!("{} {:.2}", nuisance.name, shift / nuisance.sigma))
            .collect();
        println!("      shifts/sigma {}", shifts.join(", "));
    }
}
