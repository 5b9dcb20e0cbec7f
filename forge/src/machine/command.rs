//! Commands of the servo as the drive gets them: late, or held while the servo drops out.

use super::{Machine, THETA};

fn inside(spans: &[(f64, f64)], time_s: f64) -> bool {
    spans.iter().any(|(from, to)| (*from..*to).contains(&time_s))
}

impl Machine<'_> {
    /// Keeps the command at the start of a step, for the delay, and what changes only from step to step.
    pub(super) fn note_command(&mut self, time_s: f64, pickoff_noise_rad: f64) {
        let drive = &self.truth.drive;
        if drive.delay_s > 0.0 || !drive.frozen_s.is_empty() {
            let seen = self.seen(self.states[THETA] + pickoff_noise_rad);
            let command = self.compensator.output_nm(&Self::servo(&self.states), seen);
            if self.history.is_empty() {
                self.history = vec![command; 4];
            }
            self.history.push(command);
            if self.history.len() > 65_536 {
                self.history.drain(..32_768);
            }
            self.frozen_nm = if inside(&drive.frozen_s, time_s) { self.frozen_nm.or(Some(command)) } else { None };
        }
        self.contact_now = self.truth.torque.contact.as_ref().is_some_and(|contact| inside(&contact.spans_s, time_s));
    }

    /// The command `delay` ago, `offset_s` into a step.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few thousand steps at most
    pub(super) fn delayed(&self, command: f64, command_rate: f64, offset_s: f64) -> f64 {
        let delay_s = self.truth.drive.delay_s;
        let step_s = self.track.period_s / self.steps_per_row as f64;
        if delay_s < step_s {
            return self.lately(command, command_rate, offset_s, step_s);
        }
        // steps before the start of the present one, at least 0
        let back = (delay_s - offset_s) / step_s;
        let newest = self.history.len() - 1;
        let whole = (back.floor().max(0.0) as usize).min(newest.saturating_sub(3));
        // cubic through four old commands; `place` counts back from the newest of the four
        let first = whole.saturating_sub(1);
        let place = back - first as f64;
        let value = |index: usize| self.history[newest.saturating_sub(first + index)];
        let [p, q, r, s] = [place, place - 1.0, place - 2.0, place - 3.0];
        value(0) * q * r * s / -6.0 + value(1) * p * r * s / 2.0 - value(2) * p * q * s / 2.0
            + value(3) * p * q * r / 6.0
    }
    /// The command `delay` ago, less than a step: along the cubic with its value and rate now, and its values at the last
    /// two starts of a step.
    fn lately(&self, command: f64, command_rate: f64, offset_s: f64, step_s: f64) -> f64 {
        let newest = self.history.len() - 1;
        let first = usize::from(offset_s < 1e-3 * step_s);
        let [near_s, far_s] = [first, first + 1].map(|back| offset_s + back as f64 * step_s);
        let bent = |back: usize, age_s: f64| {
            (self.history[newest.saturating_sub(back)] - command + age_s * command_rate) / (age_s * age_s)
        };
        let (near, far) = (bent(first, near_s), bent(first + 1, far_s));
        let cubic = (near - far) / (far_s - near_s);
        let square = near + cubic * near_s;
        let age_s = self.truth.drive.delay_s;
        command + age_s * (age_s * (square - age_s * cubic) - command_rate)
    }
}
