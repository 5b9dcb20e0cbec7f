//! Prints the accuracy page: `cargo run --release -p host-tests --example accuracy > docs/accuracy.md`.

fn main() {
    print!("{}", host_tests::figures::page());
}
