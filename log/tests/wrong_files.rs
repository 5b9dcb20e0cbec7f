//! Files that are wrong in one way: the message names the place and what would be right, on one line.

use gimbal_log::{Column, Log, Needs};

const HEADER: &str = "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps";

fn told(bytes: &[u8]) -> String {
    let error = Log::from_source(bytes, "f.csv", Needs::Run).expect_err("a wrong file");
    let message = error.to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

fn told_below_header(rows: &str) -> String {
    told(format!("{HEADER}\n{rows}").as_bytes())
}

#[test]
fn contract_an_empty_file_is_told() {
    assert_eq!(told(b""), "f.csv: the file is empty; a log begins with a header such as `time_s,accel_x_mps2,...`");
}

#[test]
fn contract_a_header_alone_is_told() {
    assert_eq!(told_below_header(""), "f.csv: there is a header but no row of samples below it");
    assert_eq!(told_below_header("\n\n"), "f.csv: there is a header but no row of samples below it");
}

#[test]
fn contract_text_in_a_number_cell_is_told() {
    assert_eq!(
        told_below_header("0,0,0,0,0\n0.001,0,fast,0,0\n"),
        "f.csv: line 3, column 3 (accel_y_mps2): `fast` is not a number; write a number in m/s2, or leave the cell \
         empty for a missing sample"
    );
}

#[test]
fn contract_an_infinite_value_is_told() {
    assert_eq!(
        told_below_header("0,0,0,0,-inf\n"),
        "f.csv: line 2, column 5 (vehicle_rate_radps): `-inf` is not finite; write a number in rad/s, or leave the \
         cell empty for a missing sample"
    );
    assert!(told_below_header("1e999,0,0,0,0\n").contains("column 1 (time_s): `1e999` is not finite"));
}

#[test]
fn contract_time_that_runs_backwards_is_told() {
    assert_eq!(
        told_below_header("0,0,0,0,0\n0.002,0,0,0,0\n0.001,0,0,0,0\n"),
        "f.csv: line 4, column 1 (time_s): time runs backwards, from 0.002 s to 0.001 s; sort the rows by time"
    );
}

#[test]
fn contract_a_missing_time_is_told() {
    assert_eq!(
        told_below_header("0,0,0,0,0\n,0,0,0,0\n"),
        "f.csv: line 3, column 1 (time_s): the time is missing; every row needs one"
    );
}

#[test]
fn contract_a_ragged_row_is_told() {
    let shorter = "f.csv: line 3: the row has 4 cells and the header 5; every row needs one cell for each column";
    assert_eq!(told_below_header("0,0,0,0,0\n0.001,0,0,0\n"), shorter);
    assert!(told_below_header("0,0,0,0,0,7,8\n").contains("line 2: the row has 7 cells and the header 5"));
    assert!(told_below_header("0,0,0,0,\"0\",1\n").contains("line 2: the row has 6 cells and the header 5"));
}

#[test]
fn contract_an_empty_line_between_rows_is_told() {
    let message = told_below_header("0,0,0,0,0\n\n0.001,0,0,0,0\n");
    assert_eq!(message, "f.csv: line 3: the line is empty; remove it, or write the missing row");
}

#[test]
fn contract_a_missing_column_is_told_with_the_nearest_header() {
    assert_eq!(
        told(b"time_s,accel_x_mps2,acel_y_mps2,accel_z_mps2,vehicle_rate_radps\n0,0,0,0,0\n"),
        "f.csv: line 1: there is no column `accel_y_mps2` [m/s2], needed to run the model; the nearest header is \
         `acel_y_mps2`"
    );
}

#[test]
fn contract_another_unit_is_told_with_the_command_that_converts_it() {
    assert_eq!(
        told(b"time_s,accel_x_g,accel_y_mps2,accel_z_mps2,vehicle_rate_radps\n0,0,0,0,0\n"),
        "f.csv: line 1, column 2 (accel_x_g): `accel_x_mps2` [m/s2] is needed to run the model, and this column has another \
         unit; convert it: `gimbal convert f.csv --map accel_x_mps2=accel_x_g,unit=g --out FILE.csv`"
    );
    let message = told(b"time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_dps\n0,0,0,0,0\n");
    assert!(message.contains("--map vehicle_rate_radps=vehicle_rate_dps,unit=dps"), "{message}");
}

#[test]
fn contract_bytes_that_are_not_utf8_are_told() {
    let mut bytes = format!("{HEADER},note\n0,0,0,0,0,ok\n0.001,0,0,0,0,b").into_bytes();
    bytes.extend_from_slice(b"\xff\n");
    let message = told(&bytes);
    assert_eq!(message, "f.csv: line 3, column 6 (note): byte 16 of the line is not UTF-8; save the file as UTF-8");
    assert_eq!(told(b"\xff\xfet\0i\0m\0e\0"), "f.csv: the file is UTF-16; save it as UTF-8");
}

#[test]
fn contract_a_header_that_is_none_is_told() {
    let message = told(b"time_s;accel_x_mps2\n0;0\n");
    assert_eq!(message, "f.csv: line 1: the header has no comma but has `;`; separate the cells by commas");
    let message = told(b"time_s,a,a\n0,0,0\n");
    let expected = "f.csv: line 1, column 3 (a): the name stands twice in the header, first as column 2; rename one";
    assert_eq!(message, expected);
    assert!(told(b"\"time_s,a\n0,0\n").contains("line 1: a quoted cell that begins here is not closed"));
}

#[test]
fn contract_a_file_that_is_not_there_is_told() {
    let error = Log::open(std::path::Path::new("/nowhere/f.csv"), Needs::Run).expect_err("no file");
    assert!(error.to_string().starts_with("/nowhere/f.csv: cannot be read: No such file"));
    assert!(!error.is_environment());
}

#[test]
fn contract_columns_stand_in_any_order_and_extra_ones_are_kept() {
    let text = "\u{feff}note,vehicle_rate_radps,gyro_angle_deg,accel_z_mps2,accel_y_mps2,accel_x_mps2,time_s\r\n\
                \"a, b\",1,2,3,4,5,0\r\nc,nan,2,,4,5,0.001\r\n\r\n";
    let log = Log::from_source(text.as_bytes(), "f.csv", Needs::Run).expect("reads");
    assert_eq!(log.len(), 2);
    assert_eq!(log.column(Column::AccelX), Some(&[5.0, 5.0][..]));
    assert!(log.row(1)[Column::VehicleRate].is_nan() && log.row(1)[Column::AccelZ].is_nan());
    assert_eq!((log.extras()[0].cell(0), log.extras()[1].cell(1)), ("a, b", "2"));
    assert_eq!(log.remarks, ["column 3 (gyro_angle_deg) is not read: `gyro_angle_rad` [rad] would be"]);
    let mut written = Vec::new();
    log.write(&mut written).expect("memory");
    let again = Log::from_source(&written[..], "g.csv", Needs::Run).expect("reads");
    assert_eq!(again.extras()[0].cell(0), "a, b");
    assert!(again.row(1)[Column::AccelZ].is_nan());
}
