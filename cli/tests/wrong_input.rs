//! Input that is wrong in one way: status 2, one line with file, line and column, and no file left.

mod program;

use program::{Bench, HEADER, swaying};

/// What `gimbal run` says of a log with these bytes.
fn told(bytes: impl AsRef<[u8]>) -> String {
    let bench = Bench::new();
    bench.write("flight.csv", bytes);
    let line = bench.fail(2, &["run", "flight.csv", "--out", "out.csv", "--plot", "out.svg"]);
    assert_eq!(bench.files(), ["flight.csv"]);
    assert!(line.starts_with("error: flight.csv: "), "{line}");
    line
}

fn told_below_header(rows: &str) -> String {
    told(format!("{HEADER}\n{rows}"))
}

#[test]
fn contract_logs_that_cannot_be_read_are_told() {
    assert!(told("").contains("the file is empty"));
    assert!(told_below_header("").contains("no row of samples"));
    assert!(told_below_header("0,0,0,0,0\n0.001,0,x,0,0\n").contains("line 3, column 3 (accel_y_mps2): `x` is not"));
    assert!(told_below_header("0,0,0,0,0\n0.001,0,0,0,inf\n").contains("line 3, column 5 (vehicle_rate_radps): `inf`"));
    assert!(told_below_header("0.001,0,0,0,0\n0,0,0,0,0\n").contains("line 3, column 1 (time_s): time runs backwards"));
    assert!(told_below_header("0,0,0,0,0\n0.001,0,0\n").contains("line 3: the row has 3 cells and the header 5"));
    assert!(told_below_header("0,0,0,0,0\n,0,0,0,0\n").contains("line 3, column 1 (time_s): the time is missing"));
    assert!(
        told([HEADER.as_bytes(), b"\n0,0,\xff,0,0\n"].concat()).contains("line 2, column 3 (accel_y_mps2): byte 5")
    );
}

#[test]
fn contract_a_late_mistake_leaves_no_file() {
    let mut text = swaying(5000, 1000.0);
    text += "5,oops,0,0,0,n\n";
    assert!(told(text).contains("line 5002, column 2 (accel_x_mps2): `oops`"));
}

#[test]
fn contract_missing_columns_and_other_units_are_told() {
    let header = |from: &str, to: &str| told(format!("{}\n0,0,0,0,0\n", HEADER.replace(from, to)));
    assert!(header("accel_y_mps2", "acel_y_mps2").contains("the nearest header is `acel_y_mps2`"));
    assert!(header("accel_x_mps2", "accel_x_g").contains(
        "line 1, column 2 (accel_x_g): `accel_x_mps2` [m/s2] is needed to run the model, and this column has another \
         unit; convert it: `gimbal convert flight.csv --map accel_x_mps2=accel_x_g,unit=g --out FILE.csv`"
    ));
    assert!(
        header("vehicle_rate_radps", "vehicle_rate_dps").contains("--map vehicle_rate_radps=vehicle_rate_dps,unit")
    );
}

#[test]
fn contract_a_rate_that_no_law_is_built_for_is_told() {
    let line = told(swaying(50, 100.0));
    assert!(line.contains("column `time_s`: the rate is 100.000000 Hz and the model runs at 250 to 4000 Hz"), "{line}");
    assert!(line.contains("gimbal convert flight.csv --rate-hz 1000"));
    assert!(told_below_header("0,0,0,0,0\n").contains("there is one row"));
}

#[test]
fn contract_a_long_gap_and_a_missing_beginning_are_told() {
    let gap = "0,0,0,0,0\n0.001,0,0,0,0\n0.002,0,0,0,0\n5,0,0,0,0\n";
    assert!(told_below_header(gap).contains("line 5: no row between 0.002 s and 5 s"));
    assert!(
        told_below_header("0,0,,0,0\n0.001,0,0,0,0\n").contains("line 2: `accel_y_mps2` has no sample in the first")
    );
}

#[test]
fn contract_model_files_that_are_wrong_are_told() {
    let bench = Bench::new();
    let told = |text: &str| {
        bench.write("m.toml", text);
        bench.fail(2, &["run", "--model", "m.toml", "--out", "out.csv"])
    };
    assert!(told("[gyro]\nstop_angle_deg = 0.5\n").contains("m.toml: line 2, column 1: `stop_angle_deg` is not a key"));
    assert!(told("[servo]\nmotor_lag_s = -1\n").contains("m.toml: line 2, column 15: `servo.motor_lag_s` is -1"));
    let line = told("[servo]\n\ngain_nm_per_rad_s = 80.0\n");
    assert!(line.contains("m.toml: line 3, column 21: the loop is unstable"), "{line}");
    assert_eq!(bench.files(), ["m.toml"]);
}

#[test]
fn contract_files_that_are_not_there_are_told() {
    let bench = Bench::new();
    assert!(bench.fail(2, &["run", "no.csv"]).contains("no.csv: cannot be read: No such file"));
    assert!(bench.fail(2, &["run", "--model", "no.toml"]).contains("no.toml: cannot be read: No such file"));
    assert!(bench.fail(2, &["run", "--out", "no/such/out.csv"]).contains("out-unbalance.csv: cannot be written"));
    assert!(bench.fail(2, &["convert", "no.csv", "--out", "o.csv"]).contains("no.csv: cannot be read"));
    assert!(bench.files().is_empty());
}

#[test]
fn contract_calls_that_are_wrong_are_told() {
    let bench = Bench::new();
    assert!(bench.fail(2, &["conver"]).contains("'convert'"));
    assert!(bench.fail(2, &["run", "--plnt"]).contains("'--plant'"));
    assert!(bench.fail(2, &["run", "--plant", "--number", "fixed"]).contains("cannot be used with"));
    assert!(bench.fail(2, &["run", "a.csv", "--disturbance-nm", "0.1"]).contains("exclude each other"));
    assert!(bench.fail(2, &["run", "--disturbance-nm", "big"]).contains("`big` is not a number"));
    assert!(bench.fail(2, &["convert", "a.csv"]).contains("--out <FILE.csv>"));
    let map = ["convert", "a.csv", "--out", "b.csv", "--map", "accel_x_g=ax"];
    assert!(bench.fail(2, &map).contains("`accel_x_g` is not a column of a log"));
}

#[cfg(target_os = "linux")]
#[test]
fn contract_a_full_disk_is_the_environment() {
    let bench = Bench::new();
    let line = bench.fail(3, &["run", "--disturbance-nm", "0.01", "--out", "/dev/full"]);
    assert!(line.contains("/dev/full: cannot be written: No space left"), "{line}");
}
