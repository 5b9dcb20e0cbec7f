//! Watches hours of flight with exact parameters: `cargo run --release -p host-tests --example monitor_watch -- 300`.

use std::time::Instant;

use host_tests::estimate_figures::watch;

fn main() {
    let hours = std::env::args().nth(1).and_then(|hours| hours.parse().ok()).unwrap_or(3);
    let begun = Instant::now();
    let found = watch(60 * hours, 0.0, 0.0, 1);
    println!(
        "{} alarms in {hours} h, g at most {:.2} of its threshold; {:.0} s",
        found.alarms,
        found.largest,
        begun.elapsed().as_secs_f64()
    );
}
