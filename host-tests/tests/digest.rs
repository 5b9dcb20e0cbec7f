//! The same inputs give the same bits in debug, in release and with `target-cpu=native`.

/// Frozen by `cargo run --release -p host-tests --example digest`; whoever changes them on purpose says why.
#[test]
fn regress_every_run_has_its_committed_digest() {
    let expected = include_str!("../golden/digests.txt");
    for (line, expected) in host_tests::digests::lines().lines().zip(expected.lines()) {
        assert_eq!(line, expected);
    }
    assert_eq!(host_tests::digests::lines().lines().count(), expected.lines().count());
}
