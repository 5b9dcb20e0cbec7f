//! States that remember where the axis came from.

/// Dahl's state over its limit: dz = (1 - z sgn(dq))/displacement dq, exact between rows.
pub(super) fn dahl_state(q: &[f64], displacement: f64) -> Vec<f64> {
    let mut z = 0.0_f64;
    let mut last = q[0];
    q.iter()
        .map(|&now| {
            let step = now - last;
            last = now;
            let towards = step.signum();
            if step != 0.0 {
                z = towards - (towards - z) * (-step.abs() / displacement).exp();
            }
            z
        })
        .collect()
}

/// Play over half its width: the state follows the position, clamped to +-1.
pub(super) fn play_state(q: &[f64], width: f64) -> Vec<f64> {
    let mut state = 0.0_f64;
    let mut last = q[0];
    q.iter()
        .map(|&now| {
            state = (state + 2.0 * (now - last) / width).clamp(-1.0, 1.0);
            last = now;
            state
        })
        .collect()
}
