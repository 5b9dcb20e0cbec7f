//! A record's bytes: what is read of it is whole, in order, and never more than there is.

#![no_main]

use gimbal_bench::record::Record;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(record) = Record::read(bytes, "record") {
        let length: usize = record.entries.iter().map(|entry| 13 + entry.content.len()).sum();
        assert!(11 + length <= bytes.len());
        assert!(record.cut.is_some() || 11 + length == bytes.len());
        let _ = record.header();
    }
});
