//! Files that are wrong in any way: an error of one line or a log, never a panic; and the same cells as the `csv` crate.

use gimbal_log::{Column, Log, Needs};

const HEADER: &str = "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps,note\n";

/// A stream of numbers that is the same in every run.
struct Stream(u64);

impl Stream {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).expect("31 bits") % most
    }
}

#[test]
fn contract_no_file_makes_the_reader_panic() {
    let mut stream = Stream(7);
    let whole = format!("{HEADER}0,1,2,3,4,a\n0.001,1e-3,,nan,-4.5,\"b, c\"\n0.002,1,2,3,4,\"d\ne\"\n0.003,9,8,7,6,\n");
    let pieces: [&[u8]; 12] =
        [b",", b"\n", b"\"", b"\r\n", b"\xff", b"nan", b"inf", b"-", b".", b"e", b"1e400", b"\xc3\xa9"];
    let mut read = 0;
    for _ in 0..20_000 {
        let mut bytes = whole.clone().into_bytes();
        for _ in 0..=stream.below(3) {
            let at = stream.below(bytes.len() + 1);
            match stream.below(3) {
                0 if at < bytes.len() => drop(bytes.remove(at)),
                1 => bytes.truncate(at),
                _ => drop(bytes.splice(at..at, pieces[stream.below(pieces.len())].iter().copied())),
            }
        }
        match Log::from_source(&bytes[..], "f.csv", Needs::Run) {
            Err(error) => assert!(!error.to_string().contains(['\n', '\r']), "{error}"),
            Ok(log) => {
                read += 1;
                let times_s = log.column(Column::Time).expect("needed");
                assert!(times_s.windows(2).all(|pair| pair[0] <= pair[1]));
            }
        }
    }
    assert!(read > 1000, "{read}");
}

#[test]
fn cross_rows_are_those_of_the_csv_crate() {
    let mut stream = Stream(11);
    let cells = ["", "0.5", "-3e4", " 7 ", "12345678901234567", "1", "\"2.5\"", "NaN"];
    let notes = ["plain", "\"a, b\"", "\"two\nlines\"", "\"say \"\"so\"\"\"", ""];
    for _ in 0..200 {
        let mut text = HEADER.to_owned();
        for k in 0..20 {
            let cell: Vec<&str> = (0..4).map(|_| cells[stream.below(cells.len())]).collect();
            let note = notes[stream.below(notes.len())];
            text.push_str(&[&k.to_string(), cell[0], cell[1], cell[2], cell[3], note].join(","));
            text.push_str(if stream.below(2) == 0 { "\n" } else { "\r\n" });
        }
        let log = Log::from_source(text.as_bytes(), "f.csv", Needs::Run).expect("reads");
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        for (index, record) in reader.records().enumerate() {
            let record = record.expect("csv");
            assert_eq!(log.extras()[0].cell(index), &record[5]);
            for (cell, column) in record.iter().zip(Column::ALL).take(5) {
                let expected: f64 = cell.trim().parse().unwrap_or(f64::NAN);
                let found = log.row(index)[column];
                assert!(
                    found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan()),
                    "{cell}: {found}"
                );
            }
        }
        assert_eq!(log.len(), 20);
    }
}
