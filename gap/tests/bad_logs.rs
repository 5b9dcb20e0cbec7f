//! Logs that do not serve: what is wrong with them is named, and no effect is invented. And what must not matter.

#[path = "../examples/corpus/mod.rs"]
mod corpus;

use corpus::{Case, Excitation, as_log, simulate};
use gimbal_gap::{Diagnosis, diagnose};
use gimbal_log::{Column, Log, Needs};
use gimbal_model_file::ModelFile;
use rayon::prelude::*;

const COLUMNS: [Column; 7] = [
    Column::Time,
    Column::AccelX,
    Column::AccelY,
    Column::AccelZ,
    Column::VehicleRate,
    Column::GyroAngle,
    Column::MotorTorque,
];

/// Columns of a log, to be spoiled.
#[derive(Clone)]
struct Table(Vec<(Column, Vec<f64>)>);

impl Table {
    fn of(seconds: f64, effects: &[(&'static str, Vec<f64>)]) -> Self {
        let effects = effects.to_vec();
        let case = Case { seed: 23, excitation: Excitation::Manoeuvre, seconds, effects, drift: 0.5, noise: 1.0 };
        let log = as_log(&simulate(&case));
        Self(COLUMNS.iter().map(|&column| (column, log.column(column).expect("a column").to_vec())).collect())
    }

    fn column(&mut self, column: Column) -> &mut Vec<f64> {
        &mut self.0.iter_mut().find(|own| own.0 == column).expect("a column").1
    }

    fn with(&self, column: Column, change: impl Fn(usize, f64) -> f64) -> Self {
        let mut other = self.clone();
        for (k, value) in other.column(column).iter_mut().enumerate() {
            *value = change(k, *value);
        }
        other
    }

    /// A column that lags by some rows.
    fn late(&self, column: Column, rows: usize) -> Self {
        let old = self.clone().column(column).clone();
        self.with(column, |k, _| old[k.saturating_sub(rows)])
    }

    fn swapped(&self, a: Column, b: Column) -> Self {
        let mut other = self.clone();
        for own in &mut other.0 {
            own.0 = if own.0 == a {
                b
            } else if own.0 == b {
                a
            } else {
                own.0
            };
        }
        other
    }

    fn without_rows(&self, out: impl Fn(usize) -> bool) -> Self {
        let mut other = self.clone();
        for (_, values) in &mut other.0 {
            *values = values.iter().enumerate().filter(|(k, _)| !out(*k)).map(|(_, value)| *value).collect();
        }
        other
    }

    /// Written and read as a file is, so that everything that looks at a file looks at it.
    fn log(&self, name: &str) -> Log {
        let path = std::env::temp_dir().join(format!("gimbal-gap-{}-{name}.csv", std::process::id()));
        let names: Vec<&str> = self.0.iter().map(|(column, _)| column.name()).collect();
        let mut text = names.join(",") + "\n";
        for k in 0..self.0[0].1.len() {
            let row: Vec<String> = self.0.iter().map(|(_, values)| values[k].to_string()).collect();
            text += &(row.join(",") + "\n");
        }
        std::fs::write(&path, text).expect("written");
        let log = Log::open(&path, Needs::Diagnosis).expect("a log");
        std::fs::remove_file(&path).expect("removed");
        log
    }
}

fn names(diagnosis: &Diagnosis) -> Vec<&'static str> {
    diagnosis.decision.iter().flat_map(|decision| decision.found.iter().map(|found| found.effect)).collect()
}

#[test]
fn contract_what_is_wrong_with_the_data_is_named() {
    use Column::{AccelX, AccelY, AccelZ, GyroAngle, MotorTorque, Time, VehicleRate};
    let good = Table::of(12.0, &[]);
    let wave = |k: usize| (k as f64 * 1.7).sin() * (k as f64 * 0.9).cos();
    let cases: Vec<(&str, Table, &str)> = vec![
        ("rows_missing", good.without_rows(|k| k % 4 == 1), "rows are missing"),
        ("jitter", good.with(Time, |k, time| time + 4e-4 * wave(k)), "jitter"),
        ("torque_stuck", good.with(MotorTorque, |k, torque| if k > 7000 { 1e-3 } else { torque }), "is stuck at"),
        ("rate_stuck", good.with(VehicleRate, |k, rate| if k > 9000 { 0.1 } else { rate }), "is stuck at"),
        ("theta_still", good.with(GyroAngle, |_, _| 1e-3), "never changes"),
        ("theta_sign", good.with(GyroAngle, |_, theta| -theta), "gyro_angle_rad has the wrong sign"),
        ("torque_sign", good.with(MotorTorque, |_, torque| -torque), "motor_torque_nm has the wrong sign"),
        ("rate_sign", good.with(VehicleRate, |_, rate| -rate), "vehicle_rate_radps has the wrong sign"),
        ("theta_degrees", good.with(GyroAngle, |_, theta| theta.to_degrees()), "unit seems to be degrees"),
        ("theta_twice", good.with(GyroAngle, |_, theta| theta.to_radians()), "converted twice"),
        ("rate_degrees", good.with(VehicleRate, |_, rate| rate.to_degrees()), "to be in deg/s"),
        ("rate_twice", good.with(VehicleRate, |_, rate| rate.to_radians()), "converted to rad/s twice"),
        (
            "accel_g",
            good.with(AccelX, |_, a| a / 9.806_65).with(AccelY, |_, a| a / 9.806_65).with(AccelZ, |_, a| a / 9.806_65),
            "seem to be in g",
        ),
        ("swapped_xz", good.swapped(AccelX, AccelZ), "swapped"),
        ("swapped_yz", good.swapped(AccelY, AccelZ), "swapped"),
        ("torque_late", good.late(MotorTorque, 12), "shifted in time against each other by 12.0 ms"),
        ("torque_little_late", good.late(MotorTorque, 3), "shifted in time against each other by 3.0 ms"),
        ("theta_late", good.late(GyroAngle, 12), "shifted in time against each other by -12.0 ms"),
        ("short", good.without_rows(|k| k >= 5000), "are too short"),
        (
            "constant",
            good.with(AccelX, |_, _| 1.0)
                .with(AccelY, |_, _| 2.0)
                .with(AccelZ, |_, _| 9.8)
                .with(VehicleRate, |_, _| 0.1),
            "the inputs are constant",
        ),
    ];
    let wrong: Vec<String> = cases
        .par_iter()
        .filter_map(|(name, table, told)| {
            let diagnosis = diagnose(&table.log(name), &ModelFile::default());
            let faults = &diagnosis.record.faults;
            let right = faults.iter().any(|fault| fault.contains(told)) && names(&diagnosis).is_empty();
            (!right).then(|| format!("{name}: {faults:?}, {:?} {:?}", diagnosis.verdict(), names(&diagnosis)))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn contract_a_rate_that_one_effect_alone_needs_may_stand_still() {
    let mut stuck = Table::of(12.0, &[]);
    let rate_radps = |k: usize| 0.1 * (0.01 * k.min(7000) as f64).sin();
    let rows = stuck.column(Column::Time).len();
    stuck.0.push((Column::CrossRate, (0..rows).map(rate_radps).collect()));
    let diagnosis = diagnose(&stuck.log("cross_rate_stuck"), &ModelFile::default());
    assert_eq!(diagnosis.verdict(), gimbal_gap::judge::Verdict::NoGap);
    let notes = &diagnosis.record.notes;
    assert!(notes.iter().any(|note| note.contains("cross_rate_radps is stuck")), "{notes:?}");
}

#[test]
fn contract_an_effect_that_looks_like_a_wrong_sign_is_named() {
    // the unbalance on the other side along x, and some of it along y
    let own = ModelFile::default().config.unbalance;
    let table = Table::of(20.0, &[("mass_unbalance", vec![-1.6 * own.x_kg_m, 0.3 * own.x_kg_m])]);
    let diagnosis = diagnose(&table.log("other_side"), &ModelFile::default());
    let notes = &diagnosis.decision.as_ref().expect("a decision").notes;
    assert!(notes.iter().any(|note| note.contains("has the wrong sign")), "{notes:?}");
    assert_eq!(diagnosis.record.faults, Vec::<String>::new());
    assert_eq!(names(&diagnosis), ["mass_unbalance"]);
}

#[test]
fn contract_a_fault_that_leaves_enough_invents_no_effect() {
    use Column::{AccelX, AccelY, GyroAngle, MotorTorque};
    let good = Table::of(12.0, &[]);
    let cases = [
        ("gap", good.without_rows(|k| (4000..4300).contains(&k))),
        ("missing_samples", good.with(GyroAngle, |k, theta| if k % 500 < 20 { f64::NAN } else { theta })),
        ("spike", good.with(MotorTorque, |k, torque| if k == 6000 { 1.0 } else { torque })),
        ("swapped_xy", good.swapped(AccelX, AccelY)),
    ];
    let wrong: Vec<String> = cases
        .par_iter()
        .filter_map(|(name, table)| {
            let diagnosis = diagnose(&table.log(name), &ModelFile::default());
            let told = names(&diagnosis);
            (!told.is_empty()).then(|| format!("{name}: {told:?}, {:?}", diagnosis.record.faults))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn contract_names_of_files_and_orders_of_columns_do_not_matter() {
    let table = Table::of(12.0, &[("gyro_damping", vec![0.2])]);
    let mut turned = table.clone();
    turned.0.reverse();
    turned.0.rotate_left(2);
    let [one, other] = [table.log("one"), turned.log("quite another name")]
        .map(|log| gimbal_gap::report::json(&diagnose(&log, &ModelFile::default()), "log", "model"));
    assert_eq!(one["effects"][0]["name"], "gyro_damping");
    assert_eq!(one, other);
}
