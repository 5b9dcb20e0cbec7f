//! A run as it goes: a bar and a line of figures on a terminal, and lines of a picture for the report.

use std::fmt::Write;
use std::io::IsTerminal;

use gimbal_bench::run::{self, Watch};
use gimbal_bench::scenario::Scenario;
use gimbal_servo::paper::DEGREE_RAD;
use gimbal_wire::{Estimate, Mode};
use indicatif::{ProgressBar, ProgressStyle};

use crate::interrupt;
use crate::plot::Envelope;

/// Ticks between two looks at the terminal.
const EVERY: u32 = 50;
/// Ticks without a running estimate from which on the picture is shaded: a single one is narrower than a pixel.
pub(crate) const GAP: u32 = 10;
/// Width that every terminal has.
const COLUMNS: usize = 78;
/// Stop of the paper's gyro, for the margin shown.
const STOP_RAD: f64 = 0.5 * DEGREE_RAD;

/// What is kept of a run for the report.
pub(crate) struct Live {
    bar: ProgressBar,
    pub(crate) truth: Envelope,
    pub(crate) estimate: Envelope,
    pub(crate) error: Envelope,
    /// Twice the bound, above and below.
    pub(crate) bounds: [Envelope; 2],
    pub(crate) theta: Envelope,
    pub(crate) rate: Envelope,
    pub(crate) accel: Envelope,
    pub(crate) torque: Envelope,
    /// 1 where no running estimate has come for [`GAP`] ticks.
    pub(crate) not_running: Envelope,
    gap: u32,
}

impl Live {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let bar = if std::io::stderr().is_terminal() {
            let bar = ProgressBar::new(0);
            if let Ok(style) = ProgressStyle::with_template("{prefix} {bar:30} {percent:>3} %  {eta} left\n{msg}") {
                bar.set_style(style);
            }
            bar.set_prefix(scenario.name.clone());
            bar
        } else {
            ProgressBar::hidden()
        };
        let line = Envelope::new;
        Self {
            bar,
            truth: line(),
            estimate: line(),
            error: line(),
            bounds: [line(), line()],
            theta: line(),
            rate: line(),
            accel: line(),
            torque: line(),
            not_running: line(),
            gap: 0,
        }
    }

    /// Clears the terminal.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn show(&self, live: &run::Live) {
        if self.bar.is_hidden() {
            return;
        }
        self.bar.set_length(u64::from(live.ticks));
        self.bar.set_position(u64::from(live.moment.tick));
        let (truth, row) = (&live.moment.truth, &live.moment.row);
        let ticks_a_second = f64::from(live.moment.tick) / self.bar.elapsed().as_secs_f64().max(1e-3);
        // No line is longer than a terminal of 80 columns.
        let mut lines = format!(
            "{:8.2} s  a_y {:7.1} m/s2  rate {:6.3} rad/s  {ticks_a_second:7.0} ticks/s\n\
             theta {:8.3} mrad, {:3.0} % to the stop   phi {:8.1} urad\n",
            f64::from(live.moment.tick) * live.period_s,
            row.accel_y_mps2,
            row.vehicle_rate_radps,
            1e3 * truth.gyro_angle_rad,
            100.0 * (1.0 - truth.gyro_angle_rad.abs() / STOP_RAD).max(0.0),
            1e6 * truth.gimbal_angle_rad,
        );
        let _ = match live.estimate {
            Some(estimate) => write!(
                lines,
                "estimate {:8.1} +- {:.1} urad, error {:6.1} urad, {}",
                1e6 * estimate.gimbal_angle_rad,
                1e6 * estimate.bound_rad,
                1e6 * (f64::from(estimate.gimbal_angle_rad) - truth.gimbal_angle_rad),
                estimate.mode.name()
            ),
            None => write!(lines, "no estimate"),
        };
        let mut width = usize::MAX;
        for bit in live.bits.keys() {
            let apart = if width > COLUMNS - bit.len() { "\nraised: " } else { " " };
            width = if apart == " " { width } else { 7 } + 1 + bit.len();
            lines += apart;
            lines += bit;
        }
        self.bar.set_message(lines);
    }

    fn keep(&mut self, live: &run::Live) {
        let time_s = f64::from(live.moment.tick) * live.period_s;
        let truth = &live.moment.truth;
        self.truth.push(time_s, truth.gimbal_angle_rad);
        self.theta.push(time_s, truth.gyro_angle_rad);
        self.torque.push(time_s, truth.motor_torque_nm);
        self.rate.push(time_s, live.moment.row.vehicle_rate_radps);
        self.accel.push(time_s, live.moment.row.accel_y_mps2);
        let running = live.estimate.filter(|estimate: &&Estimate| estimate.mode == Mode::Running);
        self.gap = if running.is_some() { 0 } else { self.gap + 1 };
        self.not_running.push(time_s, f64::from(u8::from(self.gap >= GAP)));
        if let Some(estimate) = live.estimate {
            // In mode safe zero: what the computer lets out.
            self.estimate.push(time_s, f64::from(estimate.gimbal_angle_rad));
        }
        if let Some(estimate) = running {
            let (angle, bound) = (f64::from(estimate.gimbal_angle_rad), 2.0 * f64::from(estimate.bound_rad));
            self.error.push(time_s, angle - truth.gimbal_angle_rad);
            // The first rows know nothing, and would hide all the others.
            if time_s >= 0.2 {
                self.bounds[0].push(time_s, bound);
                self.bounds[1].push(time_s, -bound);
            }
        }
    }
}

impl Watch for Live {
    fn tick(&mut self, live: &run::Live) -> bool {
        self.keep(live);
        if live.moment.tick.is_multiple_of(EVERY) {
            self.show(live);
        }
        !interrupt::raised()
    }
}
