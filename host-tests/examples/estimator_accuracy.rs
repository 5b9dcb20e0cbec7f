//! Prints `docs/estimator-accuracy.md`: `cargo run --release -p host-tests --example estimator_accuracy -- 300`.

fn main() {
    let hours = std::env::args().nth(1).and_then(|hours| hours.parse().ok()).unwrap_or(3);
    print!("{}", host_tests::estimate_figures::page(hours));
}
