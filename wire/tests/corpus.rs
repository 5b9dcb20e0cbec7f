//! The decoder on committed and mutated byte streams, for a bounded number of runs.
//!
//! `corpus/` holds streams that each reach another branch of the decoder; the mutations start from them.

mod arbitrary;

use std::path::Path;

use arbitrary::Random;
use gimbal_wire::{FRAME_LEN, Frame, Receiver};

/// What must hold for any bytes: accepted frames stand in the stream, as they would be sent.
fn check(bytes: &[u8]) -> Receiver {
    let mut receiver = Receiver::default();
    let mut accepted = 0;
    for (at, &byte) in bytes.iter().enumerate() {
        let Some(frame) = receiver.push(byte) else { continue };
        accepted += 1;
        let from = at + 1 - FRAME_LEN;
        assert_eq!(frame.emit(), bytes[from..=at], "{frame:?}");
    }
    assert_eq!(receiver.counts().accepted, accepted);
    let delimiters = bytes.split(|byte| *byte == 0).count() - 1;
    assert!((accepted + receiver.counts().refused()) as usize <= delimiters);
    receiver
}

fn corpus() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("a corpus")
        .map(|entry| entry.expect("an entry").path())
        .map(|path| {
            (path.file_name().unwrap_or_default().to_string_lossy().into_owned(), std::fs::read(&path).expect("read"))
        })
        .collect();
    files.sort();
    files
}

#[test]
fn regress_the_corpus_reaches_every_branch() {
    let mut reached = gimbal_wire::Counts::default();
    for (name, bytes) in corpus() {
        let receiver = check(&bytes);
        let counts = receiver.counts();
        println!("{name}: {counts:?}");
        reached.accepted += counts.accepted;
        reached.structure += counts.structure;
        reached.checksum += counts.checksum;
        reached.version += counts.version;
        reached.meaning += counts.meaning;
        reached.lost += counts.lost;
        reached.repeated += counts.repeated;
    }
    let gimbal_wire::Counts { accepted, structure, checksum, version, meaning, lost, repeated } = reached;
    for count in [accepted, structure, checksum, version, meaning, lost, repeated] {
        assert!(count > 0, "{reached:?}");
    }
}

#[test]
fn contract_mutated_streams_do_no_harm() {
    let corpus: Vec<Vec<u8>> = corpus().into_iter().map(|(_, bytes)| bytes).collect();
    let mut random = Random::new(2_026);
    for _ in 0..20_000 {
        let mut bytes = corpus[random.below(corpus.len())].clone();
        for _ in 0..=random.below(8) {
            let at = random.below(bytes.len().max(1));
            match random.below(6) {
                0 if !bytes.is_empty() => bytes[at] = random.byte(),
                1 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
                2 if !bytes.is_empty() => drop(bytes.remove(at)),
                3 => bytes.insert(at, random.byte()),
                4 => bytes.truncate(at),
                _ => bytes.extend_from_slice(&corpus[random.below(corpus.len())]),
            }
        }
        check(&bytes);
    }
}

/// Writes the corpus anew: `cargo test -p gimbal-wire --test corpus -- --ignored`.
#[test]
#[ignore = "writes files"]
fn write_the_corpus() {
    use gimbal_wire::{Hello, Message, Run};
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    std::fs::create_dir_all(&folder).expect("made");
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).expect("written");
    let frame = |sequence, message| Frame { sequence, tick: 1, message }.emit().to_vec();
    let hello = frame(0, Message::Hello(Hello { build: 0x0102_0304_0506_0708 }));
    let run = frame(5, Message::Run(Run { watchdog_ticks: 20 }));
    write("empty", &[]);
    write("delimiters", &[0; 5]);
    write("frames", &[hello.clone(), run.clone()].concat());
    write("repeated", &[run.clone(), run.clone(), hello.clone()].concat());
    write("truncated", &[&run[..20], &[0], &hello[..]].concat());
    write("joined", &[&run[..45], &hello[..]].concat());
    write("long", &[&[7; 300][..], &[0], &hello[..]].concat());
    let mut spoilt = run.clone();
    spoilt[9] ^= 0x10;
    write("checksum", &spoilt);
    let stuffed = |body: &mut [u8; 44]| {
        let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&body[..40]);
        body[40..].copy_from_slice(&checksum.to_le_bytes());
        let mut bytes = cobs::encode_vec(body);
        bytes.push(0);
        bytes
    };
    let body: [u8; 44] = cobs::decode_vec(&run[..45]).expect("stuffed").try_into().expect("44 bytes");
    let mut other = body;
    other[0] = 2;
    write("version", &stuffed(&mut other));
    let mut other = body;
    other[1] = 0x7F;
    write("kind", &stuffed(&mut other));
    let mut other = body;
    other[39] = 1;
    write("unused", &stuffed(&mut other));
    let mut jump = run;
    jump[0] = 200;
    write("stuffing", &jump);
}
