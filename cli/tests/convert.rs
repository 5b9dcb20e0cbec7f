//! `gimbal convert`: units, maps, rates, and a real rocket.

mod program;

use std::fmt::Write;

use program::{Bench, number, real};

#[test]
fn closed_form_units_and_signs_come_out_in_si() {
    let bench = Bench::new();
    let mut text = "t_ms,ax,accel_y_mps2,accel_z_mps2,rate,note\n".to_owned();
    for k in 0..20 {
        let _ = writeln!(text, "{k},1,2,3,180,a{k}");
    }
    bench.write("foreign.csv", text);
    let map = ["--map", "time_s=t_ms,unit=ms", "--map", "accel_x_mps2=ax,unit=g,sign=-1"];
    let rate = ["--map", "vehicle_rate_radps=rate,unit=dps"];
    bench.succeed(&[&["convert", "foreign.csv", "--out", "log.csv"], &map[..], &rate].concat());
    let written = bench.read("log.csv");
    let mut lines = written.lines();
    // At its rate already: rows stay as they are, with the extra column.
    assert_eq!(lines.next(), Some("time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps,note"));
    assert_eq!(lines.nth(1), Some("0.001,-9.80665,2,3,3.141592653589793,a1"));
    bench.write(
        "map.toml",
        "[time_s]\ncolumn = \"t_ms\"\nunit = \"ms\"\n[accel_x_mps2]\ncolumn = \"ax\"\nunit = \"g\"\nsign = -1\n\
         [vehicle_rate_radps]\ncolumn = \"rate\"\nunit = \"dps\"\n",
    );
    bench.succeed(&["convert", "foreign.csv", "--out", "same.csv", "--map-file", "map.toml"]);
    assert_eq!(bench.read("same.csv"), written);
    bench.succeed(&["run", "log.csv"]);
}

#[test]
fn contract_maps_that_do_not_fit_are_told() {
    let bench = Bench::new();
    bench.write("f.csv", "time_s,a,accel_y_mps2,accel_z_mps2,vehicle_rate_radps\n0,0,0,0,0\n0.001,0,0,0,0\n");
    let told = |map: &str| {
        let line = bench.fail(2, &["convert", "f.csv", "--out", "o.csv", "--map", map]);
        assert_eq!(bench.files(), ["f.csv"]);
        line
    };
    assert!(
        told("accel_x_mps2=accel_z")
            .contains("f.csv: line 1: there is no column `accel_z`; the nearest header is `accel_z_mps2`")
    );
    assert!(told("accel_x_mps2=a,unit=dps").contains("`dps` is not a unit of `accel_x_mps2`; use one of mps2, g"));
    assert!(told("accel_x_mps2=a,sign=2").contains("the sign of `accel_x_mps2` is 2; write 1 or -1"));
    assert!(told("temperature_c=a").contains("nothing gives `accel_x_mps2`"));
}

#[test]
fn closed_form_a_slow_log_is_resampled_and_told() {
    let bench = Bench::new();
    let mut text = format!("{}\n", program::HEADER);
    for k in [0, 1, 2, 2, 3, 7, 8] {
        let _ = writeln!(text, "{},{k},0,9.8,0", f64::from(k) / 100.0);
    }
    bench.write("slow.csv", text);
    let report = bench.json(&["convert", "slow.csv", "--out", "log.csv", "--json"]);
    assert_eq!((report["rows"].as_u64(), report["averaged_rows"].as_u64()), (Some(81), Some(1)));
    assert_eq!((report["source"]["gaps"].as_u64(), report["source"]["repeats"].as_u64()), (Some(1), Some(1)));
    assert!((number(&report["source"], "longest_gap_s") - 0.04).abs() < 1e-12);
    // A straight line stays one.
    for (k, line) in bench.read("log.csv").lines().skip(1).enumerate() {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let time_s = f64::from(u32::try_from(k).expect("few")) / 1000.0;
        assert!((cells[0] - time_s).abs() < 1e-12 && (cells[1] - 100.0 * time_s).abs() < 1e-9, "{line}");
    }
}

#[test]
fn cross_a_real_rocket_flies_through_the_model() {
    let Some(flight) = real("rocket/irec_2023_easymega.csv") else { return };
    let flight = flight.to_str().expect("a name");
    let bench = Bench::new();
    let told = bench.fail(2, &["run", flight]);
    assert!(told.contains("this is an AltOS export; make a log of it: `gimbal convert "), "{told}");
    let report = bench.json(&["convert", flight, "--out", "log.csv", "--json", "--to-s", "40.3"]);
    assert_eq!((report["format"].as_str(), report["gimbal_axis"].as_str()), (Some("altos"), Some("pitch")));
    assert_eq!(report["source"]["rows"], 6890);
    // Counted by another program: 162 equal neighbours, at most 33 alike, steps of 10 ms.
    assert_eq!((report["source"]["repeats"].as_u64(), report["source"]["most_alike"].as_u64()), (Some(162), Some(33)));
    assert!((number(&report["source"], "period_s") - 0.01).abs() < 1e-12);
    assert_eq!(report["rows"], 40_601);
    let run = bench.json(&["run", "log.csv", "--json"]);
    assert!(number(&run, "velocity_error_mps") > 0.01 && number(&run, "velocity_error_mps") < 1.0);
    // Thrust is along y at 16 g: the largest |a_y| of the log is that of the flight.
    let log = bench.read("log.csv");
    let largest =
        log.lines().skip(1).map(|line| line.split(',').nth(2).expect("a_y").parse::<f64>().expect("a number"));
    assert!(largest.fold(0.0, f64::max) > 150.0);
    for axis in ["roll", "yaw"] {
        bench.succeed(&["convert", flight, "--out", "other.csv", "--gimbal-axis", axis, "--to-s", "40.3"]);
        bench.succeed(&["run", "other.csv"]);
    }
}
