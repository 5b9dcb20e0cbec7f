//! A signal thinned out to its least and largest value in each of some thousand slots, in constant memory.

/// Slots; twice as many as a picture has columns of pixels.
const SLOTS: usize = 2048;

/// Least and largest value of consecutive samples.
#[derive(Debug, Clone, Copy)]
struct Slot {
    from_s: f64,
    to_s: f64,
    first: f64,
    least: f64,
    most: f64,
    last: f64,
}

impl Slot {
    fn take(&mut self, next: &Self) {
        self.to_s = next.to_s;
        self.least = self.least.min(next.least);
        self.most = self.most.max(next.most);
        self.last = next.last;
    }
}

/// A thinned-out signal. When the slots are used up, pairs of them become one.
#[derive(Debug, Clone)]
pub(crate) struct Envelope {
    slots: Vec<Slot>,
    /// Samples in a slot, and in the one that is being filled.
    each: usize,
    filled: usize,
}

impl Envelope {
    /// No sample yet.
    pub(crate) fn new() -> Self {
        Self { slots: Vec::new(), each: 1, filled: 0 }
    }

    /// Takes a sample.
    pub(crate) fn push(&mut self, time_s: f64, value: f64) {
        let sample = Slot { from_s: time_s, to_s: time_s, first: value, least: value, most: value, last: value };
        if self.filled > 0 && self.filled < self.each {
            if let Some(slot) = self.slots.last_mut() {
                slot.take(&sample);
            }
            self.filled += 1;
            return;
        }
        if self.slots.len() == SLOTS {
            self.slots = self
                .slots
                .chunks(2)
                .map(|pair| {
                    let mut slot = pair[0];
                    pair[1..].iter().for_each(|next| slot.take(next));
                    slot
                })
                .collect();
            self.each *= 2;
        }
        self.slots.push(sample);
        self.filled = 1;
    }

    /// The polyline that covers what the signal covers.
    pub(crate) fn points(&self) -> Vec<(f64, f64)> {
        let mut points = Vec::with_capacity(4 * self.slots.len());
        for slot in &self.slots {
            points.push((slot.from_s, slot.first));
            if slot.least < slot.first.min(slot.last) {
                points.push((slot.from_s, slot.least));
            }
            if slot.most > slot.first.max(slot.last) {
                points.push((slot.from_s, slot.most));
            }
            if slot.to_s > slot.from_s {
                points.push((slot.to_s, slot.last));
            }
        }
        points
    }

    /// The polyline along its largest values, or its least.
    pub(crate) fn edge(&self, largest: bool) -> Vec<(f64, f64)> {
        let value = |slot: &Slot| if largest { slot.most } else { slot.least };
        self.slots.iter().flat_map(|slot| [(slot.from_s, value(slot)), (slot.to_s, value(slot))]).collect()
    }

    /// Whether it is zero throughout.
    pub(crate) fn is_zero(&self) -> bool {
        self.slots.iter().all(|slot| slot.least == 0.0 && slot.most == 0.0)
    }

    /// Spans of time in which the signal is above a level somewhere in the slot.
    pub(crate) fn spans_above(&self, level: f64) -> Vec<(f64, f64)> {
        let mut spans: Vec<(f64, f64)> = Vec::new();
        let mut open = false;
        for slot in &self.slots {
            let above = slot.most > level;
            if above && !open {
                spans.push((slot.from_s, slot.to_s));
            }
            if (above || open)
                && let Some(span) = spans.last_mut()
            {
                span.1 = if above { slot.to_s } else { slot.from_s };
            }
            open = above;
        }
        spans
    }
}

#[cfg(test)]
mod tests {
    use super::{Envelope, SLOTS};

    #[test]
    fn closed_form_extremes_survive_thinning() {
        let mut envelope = Envelope::new();
        for k in 0..1_000_000_u32 {
            let value = if k == 777_777 { 5.0 } else { 0.0 };
            envelope.push(f64::from(k), value);
        }
        assert!(envelope.slots.len() <= SLOTS);
        let most =
            envelope.points().into_iter().fold((0.0, 0.0), |most, point| if point.1 > most.1 { point } else { most });
        assert!((most.1 - 5.0_f64).abs() < 1e-15 && (most.0 - 777_777.0_f64).abs() < 1024.0);
        let spans = envelope.spans_above(1.0);
        assert!(spans.len() == 1 && spans[0].0 <= 777_777.0 && spans[0].1 >= 777_777.0);
        assert!(!envelope.is_zero());
    }
}
