//! Frames: what is sent is what is received, whatever the bytes are.

mod arbitrary;

use gimbal_wire::{BODY_LEN, FRAME_LEN, Frame, Kind, Message, Receiver, Run, Sensor, View};
use proptest::collection::vec;
use proptest::prelude::*;

fn received(bytes: impl IntoIterator<Item = u8>) -> (Vec<Frame>, Receiver) {
    let mut receiver = Receiver::default();
    let frames = bytes.into_iter().filter_map(|byte| receiver.push(byte)).collect();
    (frames, receiver)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn contract_what_is_emitted_is_parsed(frame in arbitrary::frame()) {
        let bytes = frame.emit();
        let (frames, receiver) = received(bytes);
        prop_assert_eq!(frames, [frame]);
        prop_assert_eq!(receiver.counts().refused(), 0);
        // One zero, and it comes last: a receiver that joins late waits for one frame at most.
        prop_assert_eq!(bytes.iter().position(|byte| *byte == 0), Some(FRAME_LEN - 1));
    }

    #[test]
    fn cross_stuffing_is_that_of_another_cobs(frame in arbitrary::frame()) {
        let bytes = frame.emit();
        let body = cobs::decode_vec(&bytes[..FRAME_LEN - 1]).expect("stuffed");
        prop_assert_eq!(body.len(), BODY_LEN);
        prop_assert_eq!(cobs::encode_vec(&body), &bytes[..FRAME_LEN - 1]);
        let body: [u8; BODY_LEN] = body.try_into().expect("a body");
        prop_assert_eq!(View::new(&body).expect("checked").message(), Some(frame.message));
    }

    #[test]
    fn contract_any_bytes_do_no_harm(bytes in vec(prop_oneof![Just(0_u8), any::<u8>()], 0..400)) {
        let (_, mut receiver) = received(bytes.iter().copied());
        // Nothing that came before stands in the way of the next frame but its own unfinished rest.
        let frame = Frame { sequence: 1, tick: 2, message: Message::Stop };
        let after: Vec<Frame> = std::iter::once(0).chain(frame.emit()).filter_map(|byte| receiver.push(byte)).collect();
        prop_assert_eq!(after, [frame]);
    }

    #[test]
    fn contract_one_form_for_each_meaning(payload in any::<[u8; 32]>(), kind in 0_usize..17) {
        // A body that is accepted is the one that its message is sent as: nothing hides in unused bytes.
        let mut body = [0; BODY_LEN];
        body[0] = gimbal_wire::VERSION;
        body[1] = Kind::ALL[kind] as u8;
        body[8..40].copy_from_slice(&payload);
        let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&body[..40]);
        body[40..].copy_from_slice(&checksum.to_le_bytes());
        let view = View::new(&body).expect("checked");
        if let Some(message) = view.message() {
            let again = Frame { sequence: view.sequence(), tick: view.tick(), message }.emit();
            prop_assert_eq!(cobs::decode_vec(&again[..FRAME_LEN - 1]).expect("stuffed"), body);
        }
    }
}

#[test]
fn closed_form_errors_of_a_few_bits_are_found() {
    // The distance of this CRC at 44 bytes is 6: below it every pattern is found. All pairs, and many of the others.
    let frame = Frame { sequence: 9, tick: 77, message: Message::Run(Run { watchdog_ticks: 20 }) };
    let body: [u8; BODY_LEN] =
        cobs::decode_vec(&frame.emit()[..FRAME_LEN - 1]).expect("stuffed").try_into().expect("44");
    let flipped = |bits: &[usize]| {
        let mut body = body;
        for bit in bits {
            body[bit / 8] ^= 1 << (bit % 8);
        }
        body
    };
    let bits = 8 * BODY_LEN;
    for first in 0..bits {
        for second in first..bits {
            // The same bit twice would be no error: it stands for one bit alone.
            let pair = [first, second];
            let changed = flipped(if first == second { &pair[..1] } else { &pair });
            assert!(View::new(&changed).is_err(), "bits {first} and {second}");
        }
    }
    let mut random = arbitrary::Random::new(5);
    for _ in 0..200_000 {
        let mut some: Vec<usize> = (0..3 + random.below(3)).map(|_| random.below(bits)).collect();
        some.sort_unstable();
        some.dedup();
        assert!(View::new(&flipped(&some)).is_err(), "bits {some:?}");
    }
}

#[test]
fn contract_values_that_are_no_numbers_keep_their_bits() {
    for bits in [0x7FC0_0000_u32, 0x7FA0_1234, 0xFF80_0000, 0x0000_0001] {
        let value = f32::from_bits(bits);
        let sensor = Sensor {
            accel_mps2: [value; 3],
            vehicle_rate_radps: value,
            gyro_angle_rad: Some(value),
            motor_torque_nm: None,
        };
        let (frames, _) = received(Frame { sequence: 0, tick: 0, message: Message::Sensor(sensor) }.emit());
        let [Frame { message: Message::Sensor(again), .. }] = frames[..] else { panic!("{frames:?}") };
        assert_eq!(again.accel_mps2.map(f32::to_bits), [bits; 3]);
        assert_eq!(again.gyro_angle_rad.map(f32::to_bits), Some(bits));
        assert_eq!(again.motor_torque_nm, None);
    }
}

#[test]
fn contract_the_page_holds_true() {
    let page = include_str!("../../docs/wire.md");
    // Every example: a line `hex: ..`, and the line after it, which is what the frame says.
    let mut lines = page.lines().map(str::trim);
    let mut examples = 0;
    while let Some(line) = lines.next() {
        let Some(hex) = line.strip_prefix("hex: ") else { continue };
        let bytes: Vec<u8> = hex.split(' ').map(|byte| u8::from_str_radix(byte, 16).expect("hex")).collect();
        let told = lines.next().and_then(|line| line.strip_prefix("says: ")).expect("what it says");
        let (frames, receiver) = received(bytes.iter().copied());
        assert_eq!(receiver.counts().refused(), 0, "{hex}");
        let [frame] = frames[..] else { panic!("{} frames in {hex}", frames.len()) };
        assert_eq!(format!("{frame:?}"), told);
        assert_eq!(frame.emit().as_slice(), bytes);
        examples += 1;
    }
    assert_eq!(examples, 2);
    for kind in Kind::ALL {
        assert!(page.contains(&format!("| `{kind:?}` | 0x{:02x} |", kind as u8)), "{kind:?} is not on the page");
    }
}
