//! INS velocity and position error over an hour: sums that do not drift.

use gimbal_servo::{Config, Fixed};
use host_tests::Row;
use host_tests::hour::{Totals, plant_hour, steady, turning};

/// One hour; a debug build sums five minutes of one.
const ROWS: u32 = if cfg!(debug_assertions) { 300_000 } else { 3_600_000 };

type Profile = (&'static str, fn(u32) -> Row);
const PROFILES: [Profile; 2] = [("steady", steady), ("turning", turning)];

fn both(config: &Config, row: fn(u32) -> Row) -> [(&'static str, Totals); 2] {
    [("f32", Totals::of::<f32>(config, ROWS, row)), ("fixed", Totals::of::<Fixed>(config, ROWS, row))]
}

/// Asked for: 1e-6 of the exact sum of the same phi samples. Counts are 2^-16 m/s2 with nothing lost between
/// them; the position leaves out what the velocity carries, less than 1.5e-8 m/s of more than 0.1 m/s.
#[test]
fn closed_form_an_hour_of_sums_is_exact() {
    let config = Config::consistent().without_friction();
    for (name, row) in PROFILES {
        for (system, totals) in both(&config, row) {
            let (velocity, position) = (totals.velocity_error(), totals.position_error());
            assert!(position <= 1e-6 && velocity <= 1e-6, "{name} {system}: {position:e} {velocity:e}");
        }
    }
}

/// Asked for: 1e-3 of the plant. The steady case is the hard one: phi is zero to the last bit for an hour, and a bias of
/// half a bit of fixed point, 2.3e-10 rad, would be 1.6e-4 m/s at 20 g, 1.5e-3 of the velocity error.
#[test]
fn cross_an_hour_at_20_g_agrees_with_the_plant() {
    let config = Config::consistent().without_friction();
    for (name, row) in PROFILES {
        let (velocity_mps, position_m) = plant_hour(&config, ROWS, row);
        for (system, totals) in both(&config, row) {
            let (velocity, position) = (totals.velocity_off(velocity_mps), totals.position_off(position_m));
            println!("{name} {system}: velocity off by {velocity:.2e}, position by {position:.2e}");
            assert!(velocity <= 1e-3 && position <= 1e-3, "{name} {system}: {velocity:e} {position:e}");
        }
    }
}
