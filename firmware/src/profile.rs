//! What the axis of the program `flight` meets in its minute, in whole counts: the recorded flight six times over, the last
//! time with a torque beside it that throws the gyro from stop to stop. The build script reads this file, too.

/// Steps.
pub const STEPS: u32 = 60_000;
/// Steps of the recorded flight.
pub const FLIGHT_STEPS: u32 = 10_000;
/// The first step with the torque.
pub const STOPS_FROM: u32 = STEPS - FLIGHT_STEPS;

/// Acceleration along x, y and z, vehicle rate, external torque.
#[must_use]
pub fn met(rows: &[[i16; 4]], k: u32) -> [i32; 5] {
    let [x, y, z, rate] = between(rows, k % FLIGHT_STEPS);
    [x, y, z, rate, torque(k)]
}

/// Rows at 100 Hz as rows at 1 kHz in tenths of their units, interpolated linearly: exactly, in integers.
#[must_use]
pub fn between(rows: &[[i16; 4]], k: u32) -> [i32; 4] {
    let (at, part) = ((k / 10) as usize, (k % 10).cast_signed());
    let [row, next] = [at, at + 1].map(|i| rows.get(i).copied().unwrap_or_default().map(i32::from));
    core::array::from_fn(|i| 10 * row[i] + (next[i] - row[i]) * part)
}

/// 0.035 N m for 0.4 s, nothing for 0.3 s, the same the other way: contact and release each time.
fn torque(k: u32) -> i32 {
    const TORQUE: i32 = 3_500;
    match (k >= STOPS_FROM, (k.saturating_sub(STOPS_FROM)) % 1_400) {
        (true, 0..400) => TORQUE,
        (true, 700..1_100) => -TORQUE,
        _ => 0,
    }
}
