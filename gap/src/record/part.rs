//! A part of a record as one of its own.

use std::ops::Range;

use gimbal_servo::bearing;

use super::{Channel, Record, SHORTEST_S};
use crate::simulate::Inputs;

/// How long a wrong beginning may last [s].
pub(crate) const BEGINNING_S: f64 = 1.0;

impl Record {
    /// The longest run of rows away from the stop; none where the stop was not reached, or the run is too short.
    pub(crate) fn away_from_stop(&self, bearing: &bearing::Config) -> Option<Self> {
        self.part(self.away_from_stop.clone()?, bearing, "no prediction goes through the stop", "away from it")
    }

    /// What follows its first second; none where that is too short.
    pub(crate) fn after_its_beginning(&self, bearing: &bearing::Config) -> Option<Self> {
        let from = self.inputs.rows_of(BEGINNING_S);
        self.part(from..self.rows(), bearing, "no prediction gets away from the beginning", "past it")
    }

    fn part(&self, rows: Range<usize>, bearing: &bearing::Config, why: &str, which: &str) -> Option<Self> {
        let period_s = self.inputs.period_s;
        let [from_s, to_s] = [rows.start, rows.end].map(|row| row as f64 * period_s);
        if to_s - from_s < SHORTEST_S {
            return None;
        }
        let cut = |values: &[f64]| values.get(rows.clone()).map(<[f64]>::to_vec).unwrap_or_default();
        let mut inputs = Inputs {
            period_s,
            start_s: self.inputs.start_s + from_s,
            accel_mps2: self.inputs.accel_mps2.each_ref().map(|axis| cut(axis)),
            rate_radps: cut(&self.inputs.rate_radps),
            cross_radps: cut(&self.inputs.cross_radps),
            ..Inputs::default()
        };
        inputs.complete(bearing, self.inputs.turned_rad[rows.start]);
        let channel = |channel: &Channel| Channel {
            signal: channel.signal,
            values: cut(&channel.values),
            valid: channel.valid[rows.clone()].to_vec(),
            hums_hz: channel.hums_hz.clone(),
            converter: channel.converter,
        };
        let inside = |gap: &Range<usize>| {
            gap.start.saturating_sub(rows.start)..gap.end.saturating_sub(rows.start).min(rows.len())
        };
        let unknown = self.unknown.iter().map(inside).filter(|gap| !gap.is_empty()).collect();
        let mut notes = self.notes.clone();
        notes
            .push(format!("{why}: {from_s:.1} s to {to_s:.1} s after the first row, {which}, are taken by themselves"));
        let mut part = Self {
            first_s: self.first_s + from_s,
            inputs,
            channels: self.channels.iter().map(channel).collect(),
            plateau_rad: self.plateau_rad,
            away_from_stop: None,
            unknown,
            anew: Vec::new(),
            is_rounded: self.is_rounded,
            rate_noise: self.rate_noise.clone(),
            motor_noise_nm: self.motor_noise_nm,
            force_noise: self.force_noise,
            faults: Vec::new(),
            notes,
        };
        part.begins_anew_after_gaps();
        Some(part)
    }
}
