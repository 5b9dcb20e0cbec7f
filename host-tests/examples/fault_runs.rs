//! Throws sensor faults at the estimator and prints each one that moves phi by more than twice the bound without a flag:
//! `cargo run --release -p host-tests --example fault_runs -- RUNS SEED...`.

use host_tests::estimate_faults::faults;

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|word| word.parse().ok());
    let runs = numbers.next().unwrap_or(10_000);
    let seeds: Vec<u64> = numbers.map(|seed: usize| seed as u64).collect();
    for seed in if seeds.is_empty() { vec![21] } else { seeds } {
        let found = faults(runs, seed);
        println!("seed {seed}: {} of {} runs, at most {:.1} bounds", found.unflagged, found.runs, found.worst);
        for which in found.which {
            println!("  {which}");
        }
    }
}
