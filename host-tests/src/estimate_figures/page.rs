//! The page.

use std::fmt::Write;
use std::thread;

use super::{
    Acting, Case, EFFECTS, Saturations, Wrong, cases, free_score, saturations, smallest, watch, watch_plant,
    wrong_score,
};
use crate::axis::System;
use crate::estimate_faults::{Found, faults};

/// The page.
///
/// # Panics
/// Never: writing to a string.
#[must_use]
pub fn page(hours: u32) -> String {
    let mut text = String::from(
        "# What the estimator reaches\n\nPrinted by `cargo run --release -p host-tests --example estimator_accuracy -- HOURS` \
         (hours of the\nmonitor's watch). Truth from `plant/`; pick-off 2 urad rms, 16 bit over +-10 mrad, motor torque 1e-5 N m, \
         accelerometers\n0.01 m/s2, rate 2e-4 rad/s rms.\n\n## Without saturation, parameters exact\n\n| flight | attitude, f32 | \
         fixed | static ratio | velocity, f32 | rows within 2 sigma |\n|---|---|---|---|---|---|\n",
    );
    let cases = cases(4);
    for case in &cases {
        let ((float, stops), (fixed, _)) = (free_score(case, System::F32), free_score(case, System::Fixed));
        writeln!(
            text,
            "| {}{} | {:.2} % | {:.2} % | {:.2} % | {:.2} % | {:.1} % |",
            case.name,
            if stops { " (saturates)" } else { "" },
            100.0 * float.attitude,
            100.0 * fixed.attitude,
            100.0 * float.static_ratio,
            100.0 * float.velocity,
            100.0 * float.coverage
        )
        .expect("a string");
    }
    text += "\n## Every parameter wrong by up to 10 %\n\n| flight | runs | largest attitude error beyond that of Bo/H | \
             largest velocity error beyond it | rows within 2 sigma |\n|---|---|---|---|---|\n";
    for case in &cases {
        let (mut runs, mut attitude, mut velocity, mut coverage) = (0, f64::MIN, f64::MIN, 0.0);
        for seed in 0..20 {
            let Some(Wrong { score, ratio, saturates: false, .. }) = wrong_score(case, seed) else { continue };
            runs += 1;
            attitude = attitude.max(score.attitude - ratio);
            velocity = velocity.max(score.velocity - ratio);
            coverage += score.coverage;
        }
        if runs > 0 {
            writeln!(
                text,
                "| {} | {runs} | {:+.2} % | {:+.2} % | {:.1} % |",
                case.name,
                100.0 * attitude,
                100.0 * velocity,
                100.0 * coverage / f64::from(runs)
            )
            .expect("a string");
        }
    }
    if let Some(case) = cases.iter().find(|case| case.name == "rocket, roll") {
        roll_page(&mut text, case);
    }
    text += "\n## Through saturation\n\n1,000 steps of 2.15e5 to 4e5 dyne cm, ramps of 1 to 40 ms, 0.05 to 0.7 s on the stop.\n\n| parameters | \
             median error of the offset | 95 % | largest | median bound | offsets within 2 sigma | rows before, on, after | \
             announced 5 ms ahead |\n|---|---|---|---|---|---|---|---|\n";
    for (name, tolerance) in [("exact", 0.0), ("3 % each", 0.03)] {
        let found = saturations(1_000, tolerance, System::F32, 11);
        let percent = |(within, all): (usize, usize)| 100.0 * within as f64 / all.max(1) as f64;
        let [before, on, after] = found.rows.map(percent);
        writeln!(
            text,
            "| {name} | {:.2} % | {:.2} % | {:.2} % | {:.2} % | {:.1} % | {before:.1} %, {on:.1} %, {after:.1} % | {:.1} % |",
            100.0 * Saturations::quantile(&found.errors, 500),
            100.0 * Saturations::quantile(&found.errors, 950),
            100.0 * Saturations::quantile(&found.errors, 1000),
            100.0 * Saturations::quantile(&found.bounds, 500),
            100.0 * found.coverage(),
            100.0 * found.announced as f64 / found.runs() as f64
        )
        .expect("a string");
    }
    fault_page(&mut text);
    monitor_page(&mut text, hours);
    text
}

/// Run by run, what the rocket's roll axis, whose theta ends at its stop, comes to.
fn roll_page(text: &mut String, case: &Case) {
    text.push_str(
        "\nRocket, roll, run by run: theta comes within a few percent of the stop, whose place is as uncertain as all else.\n\n| truth | theta's \
         peak over the true stop | over the nominal one | estimate says | attitude error beyond that of Bo/H | velocity error beyond it | rows within \
         2 sigma |\n|---|---|---|---|---|---|---|\n",
    );
    for seed in 0..20 {
        let Some(wrong) = wrong_score(case, seed) else { continue };
        let said = match wrong.said {
            [false, _] => "free",
            [true, false] => "saturated",
            [true, true] => "saturated, offset doubtful",
        };
        writeln!(
            text,
            "| {} | {:.3} | {:.3} | {said} | {:+.2} % | {:+.2} % | {:.1} % |",
            if wrong.saturates { "saturates" } else { "free" },
            wrong.reach[0],
            wrong.reach[1],
            100.0 * (wrong.score.attitude - wrong.ratio),
            100.0 * (wrong.score.velocity - wrong.ratio),
            100.0 * wrong.score.coverage
        )
        .expect("a string");
    }
}

/// Of what theta does that is granted to the model.
const GRANTED: [f64; 5] = [0.0, 0.03, 0.06, 0.1, 0.15];

fn monitor_page(text: &mut String, hours: u32) {
    let law = watch(60 * hours, 0.0, 0.0, 1);
    let plant = watch_plant(60, 2);
    write!(
        text,
        "\n## Gap monitor\n\nParameters exact: {} alarms in {hours} h against the law itself, g at most {:.2} of its threshold; {} in 1 h \
         against the plant,\nat most {:.2}.\n\n| effect, 10 urad rms | times its typical size | flagged after |\n|---|---|---|\n",
        law.alarms, law.largest, plant.alarms, plant.largest
    )
    .expect("a string");
    for name in EFFECTS {
        let acting = Acting::new(name);
        let seen = acting.seen(&acting.grown(1e-5), 0.0);
        let after = seen.after_s.map_or_else(|| "not within 5 s".into(), |after| format!("{after:.2} s"));
        writeln!(text, "| `{name}` | {:.3} | {after} |", seen.factor).expect("a string");
    }
    text.push_str(
        "\nThe ten effects are the first of each of the six blocks of the list of effects, then the second of each, until there are ten.\n\
         Those that act at the bearing's reversals alone are seen there: a passage of the clamp's zone is granted what the rate's noise makes, a\n\
         bearing that creeps four times that. One of the watched flights in four turns down to a thousand times slower, so that its bearing creeps.\n\n\
         The smallest effect that is flagged within 5 s, as theta's change, rms, and in times its typical size, to a factor of 1.25 below 20 urad and of 1.5\n\
         above, for what the model is granted; and how many of 600 minutes of flight alarm without any effect:\n\n| |",
    );
    for granted in GRANTED {
        write!(text, " {:.0} % |", 100.0 * granted).expect("a string");
    }
    text.push_str("\n|---|---|---|---|---|---|\n");
    for (drift, name) in [(0.0, "exact"), (0.03, "off by up to 3 % each")] {
        write!(text, "| alarms, parameters {name} |").expect("a string");
        for granted in GRANTED {
            write!(text, " {} |", watch(600, drift, granted, 4).alarms).expect("a string");
        }
        text.push('\n');
    }
    let rows = thread::scope(|scope| {
        let rows = EFFECTS.map(|name| scope.spawn(move || smallest(name, &GRANTED)));
        rows.map(|row| row.join().expect("no panic"))
    });
    for (name, row) in EFFECTS.iter().zip(rows) {
        write!(text, "| `{name}` |").expect("a string");
        for seen in row {
            match seen {
                Some(seen) => write!(text, " {:.0} urad, {:.2} |", 1e6 * seen.change_rad, seen.factor),
                None => write!(text, " none up to 2 mrad |"),
            }
            .expect("a string");
        }
        text.push('\n');
    }
}

/// Seeds of 10,000 faults each.
const FAULT_SEEDS: [u64; 8] = [21, 22, 23, 24, 25, 26, 27, 28];

fn fault_page(text: &mut String) {
    let found = thread::scope(|scope| {
        let runs = FAULT_SEEDS.map(|seed| scope.spawn(move || faults(10_000, seed)));
        runs.map(|run| run.join().expect("no panic"))
    });
    let sum = |of: fn(&Found) -> usize| found.iter().map(of).sum::<usize>();
    let which: Vec<&str> = found.iter().flat_map(|found| &found.which).map(String::as_str).collect();
    write!(
        text,
        "\n## Sensor faults\n\nStale, stuck, spiking, not finite, out of range; theta, motor torque, accelerations, rate; at random times of ten \
         flights,\nfive of which saturate, the flights new for every 10,000. Against the same run without the fault, in {} runs {} moved phi by more \
         than twice the bound without\na flag, at most by {:.1} bounds: {}. One by one: `cargo run --release -p host-tests --example fault_runs -- 10000 \
         SEED...`.\n",
        sum(|found| found.runs),
        sum(|found| found.unflagged),
        found.iter().fold(0.0_f64, |most, found| most.max(found.worst)),
        if which.is_empty() { "none".to_owned() } else { which.join("; ") }
    )
    .expect("a string");
}
