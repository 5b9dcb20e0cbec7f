//! The simulated platform, one moment a tick, computed ahead in a thread of its own.
//!
//! The computer's answers do not act on the platform: they correct the navigation, not the gimbal. So the platform may
//! run ahead of the link.

use std::sync::mpsc::{Receiver, sync_channel};

use gimbal_plant::{Row, Sample};
use gimbal_wire::Sensor;

use crate::profile::Motion;
use crate::scenario::Scenario;
use crate::sensor::Sensors;

/// Moments handed over at once.
const PORTION: usize = 256;
/// Portions ahead.
const AHEAD: usize = 16;

/// Truth and readings of one tick.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Number of the tick.
    pub tick: u32,
    /// The inputs.
    pub row: Row,
    /// The truth.
    pub truth: Sample,
    /// What the sensors read.
    pub sensor: Sensor,
}

/// Moments of a scenario, in order.
#[derive(Debug)]
pub struct Platform {
    /// How many there are.
    pub ticks: u32,
    portions: Receiver<Vec<Moment>>,
    portion: std::vec::IntoIter<Moment>,
}

impl Platform {
    /// Starts the platform of a scenario.
    ///
    /// # Errors
    /// A log that cannot be read.
    pub fn start(scenario: &Scenario) -> Result<Self, String> {
        let (plant, motion) = (scenario.plant()?, Motion::new(scenario)?);
        let mut sensors = Sensors::new(scenario.noise, &scenario.sensor_faults, scenario.seed);
        let period_s = plant.period_s();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a day at 4 kHz fits")]
        let ticks = (scenario.duration_s.min(motion.end_s()) / period_s).round() as u32;
        let (full, portions) = sync_channel(AHEAD);
        std::thread::spawn(move || {
            let mut state = plant.start();
            let mut last: Option<Row> = None;
            let mut portion = Vec::with_capacity(PORTION);
            for tick in 0..ticks {
                let time_s = f64::from(tick) * period_s;
                let row = motion.at(time_s);
                let truth = match &last {
                    Some(last) => plant.step(&mut state, last, &row),
                    None => plant.sample(&state, &row),
                };
                last = Some(row);
                portion.push(Moment { tick, row, truth, sensor: sensors.read(time_s, &truth) });
                if portion.len() == PORTION || tick + 1 == ticks {
                    // The bench has ended before its time.
                    if full.send(std::mem::take(&mut portion)).is_err() {
                        return;
                    }
                }
            }
        });
        Ok(Self { ticks, portions, portion: Vec::new().into_iter() })
    }
}

impl Iterator for Platform {
    type Item = Moment;

    fn next(&mut self) -> Option<Moment> {
        if let Some(moment) = self.portion.next() {
            return Some(moment);
        }
        self.portion = self.portions.recv().ok()?.into_iter();
        self.portion.next()
    }
}
