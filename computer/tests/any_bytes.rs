//! Whatever comes over the wire, the computer steps on and its output stays within its limits.

mod bench;

use bench::Bench;
use gimbal_computer::limits;
use gimbal_wire::{Message, Mode, Sensor};
use proptest::collection::vec;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn contract_any_bytes_do_no_harm(chunks in vec(vec(prop_oneof![Just(0_u8), any::<u8>()], 0..200), 0..20)) {
        let mut bench = Bench::started();
        for chunk in chunks {
            bench.computer.receive(&chunk);
            bench.computer.receive(&[0]);
            bench.answers();
            let estimate = bench.step(1e-5);
            prop_assert!(estimate.gimbal_angle_rad.abs() <= limits::CORRECTION_RAD);
        }
    }

    #[test]
    fn contract_any_sensor_bits_do_no_harm(rows in vec(any::<[u32; 6]>(), 1..60)) {
        let mut bench = Bench::started();
        for row in rows {
            let [x, y, z, rate, gyro, torque] = row.map(f32::from_bits);
            bench.tick += 1;
            bench.send(Message::Sensor(Sensor {
                accel_mps2: [x, y, z],
                vehicle_rate_radps: rate,
                gyro_angle_rad: Some(gyro),
                motor_torque_nm: Some(torque),
            }));
            bench.tick -= 1;
            let estimate = bench.clock();
            prop_assert!(estimate.gimbal_angle_rad.is_finite() && estimate.bound_rad.is_finite());
        }
    }
}

#[test]
fn regress_the_corpus_of_the_wire_does_no_harm() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../wire/tests/corpus");
    let streams: Vec<Vec<u8>> = std::fs::read_dir(folder)
        .expect("a corpus")
        .map(|entry| std::fs::read(entry.expect("an entry").path()).expect("read"))
        .collect();
    assert!(streams.len() > 10);
    // Each by itself, and each cut anywhere behind each other.
    for first in &streams {
        for second in &streams {
            let mut bench = Bench::started();
            bench.computer.receive(&first[..first.len() / 2]);
            bench.computer.receive(second);
            bench.computer.receive(&[0]);
            bench.answers();
            let mode = bench.clock().mode;
            assert!(matches!(mode, Mode::Running | Mode::Ready | Mode::Empty), "{mode:?}");
        }
    }
}
