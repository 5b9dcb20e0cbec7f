//! Prints the digest of every frozen run. New reference digests, after a change that is meant to change bits:
//!
//! ```text
//! cargo run --release -p host-tests --example digest > host-tests/golden/digests.txt
//! ```

fn main() {
    print!("{}", host_tests::digests::lines());
}
