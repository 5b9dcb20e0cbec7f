//! Link faults as decorators: each takes the frames of a tick and gives what comes out of it at the other end.

use gimbal_wire::{Frame, Message};

use crate::random::Random;
use crate::scenario::{LinkFault, LinkFaultKind, Way};

/// Frames, or what is left of them.
type Frames = Vec<Vec<u8>>;

/// All faults of one way, in the order of the scenario.
#[derive(Debug, Clone)]
pub(crate) struct Faults(Vec<Fault>);

/// One fault with its memory.
#[derive(Debug, Clone)]
struct Fault {
    kind: LinkFaultKind,
    rate: f64,
    amount: u16,
    ticks: std::ops::Range<u32>,
    random: Random,
    /// Frames that come later, and when.
    held: Vec<(u32, Vec<u8>)>,
}

impl Faults {
    pub(crate) fn new(faults: &[LinkFault], way: Way, seed: u64, period_s: f64) -> Self {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a day at 4 kHz fits")]
        let tick = |time_s: f64| (time_s / period_s).round() as u32;
        let of_way = faults.iter().enumerate().filter(|(_, fault)| fault.way == way);
        Self(
            of_way
                .map(|(index, fault)| Fault {
                    kind: fault.kind,
                    rate: fault.rate,
                    amount: fault.amount,
                    ticks: tick(fault.from_s)..tick(fault.to_s),
                    random: Random::new(seed, 1 + index as u64),
                    held: Vec::new(),
                })
                .collect(),
        )
    }

    /// What comes out of the frames of a tick.
    pub(crate) fn pass(&mut self, tick: u32, frames: Frames) -> Frames {
        self.0.iter_mut().fold(frames, |frames, fault| fault.pass(tick, frames))
    }
}

impl Fault {
    fn pass(&mut self, tick: u32, frames: Frames) -> Frames {
        let mut out = Vec::with_capacity(frames.len());
        let acts = self.ticks.contains(&tick);
        for frame in frames {
            if acts { self.act(tick, frame, &mut out) } else { out.push(frame) }
        }
        // What was held comes behind what is on time.
        let (due, later) = std::mem::take(&mut self.held).into_iter().partition(|(at, _)| *at <= tick);
        self.held = later;
        out.extend(Vec::into_iter(due).map(|(_, frame): (u32, Vec<u8>)| frame));
        out
    }

    fn act(&mut self, tick: u32, mut frame: Vec<u8>, out: &mut Frames) {
        let (random, amount) = (&mut self.random, usize::from(self.amount));
        match self.kind {
            LinkFaultKind::BitFlips => {
                for byte in &mut frame {
                    if random.happens(self.rate) {
                        *byte ^= 1 << random.below(8);
                    }
                }
                return out.push(frame);
            }
            LinkFaultKind::ByteErrors => {
                for byte in &mut frame {
                    if random.happens(self.rate) {
                        *byte = byte.wrapping_add(1).wrapping_add(random.byte() % 255);
                    }
                }
                return out.push(frame);
            }
            _ => {}
        }
        if !random.happens(self.rate) {
            return out.push(frame);
        }
        match self.kind {
            LinkFaultKind::Drop | LinkFaultKind::Disconnect => {}
            LinkFaultKind::Repeat => out.extend([frame.clone(), frame]),
            LinkFaultKind::Reorder => self.held.push((tick + 1, frame)),
            LinkFaultKind::Delay => self.held.push((tick + u32::from(self.amount), frame)),
            LinkFaultKind::Truncate => {
                frame.truncate(random.below(frame.len()));
                out.push(frame);
            }
            LinkFaultKind::NoiseBurst => {
                out.push((0..amount).map(|_| random.byte()).collect());
                out.push(frame);
            }
            LinkFaultKind::Flood => {
                out.push(frame);
                let useless = Frame { sequence: 0, tick, message: Message::ReadFaults };
                out.extend((0..amount).map(|_| useless.emit().to_vec()));
            }
            LinkFaultKind::BitFlips | LinkFaultKind::ByteErrors => out.push(frame),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Faults, Frames};
    use crate::scenario::{LinkFault, LinkFaultKind, Way};

    fn passed(kind: LinkFaultKind, rate: f64, amount: u16) -> Vec<Frames> {
        let fault = LinkFault { kind, way: Way::Down, rate, amount, from_s: 0.1, to_s: 0.2 };
        let mut faults = Faults::new(&[fault], Way::Down, 3, 1e-3);
        (0..400_u32).map(|tick| faults.pass(tick, vec![vec![tick.to_be_bytes()[3]; 46]])).collect()
    }

    #[test]
    fn contract_each_fault_does_what_its_name_says_and_nothing_outside_its_time() {
        use LinkFaultKind::{BitFlips, Delay, Disconnect, Drop, Flood, NoiseBurst, Reorder, Repeat, Truncate};
        for kind in [BitFlips, Delay, Disconnect, Drop, Flood, NoiseBurst, Reorder, Repeat, Truncate] {
            let ticks = passed(kind, 0.3, 4);
            for (tick, frames) in ticks.iter().enumerate() {
                let clean = frames.len() == 1 && frames[0] == [u8::try_from(tick & 255).expect("a byte"); 46];
                assert!(clean || (100..205).contains(&tick), "{kind:?} at {tick}");
            }
            let spoilt = ticks.iter().filter(|frames| frames.len() != 1 || frames[0].len() != 46).count();
            assert!(spoilt > 10 || kind == BitFlips, "{kind:?}: {spoilt}");
            let bytes = ticks.iter().flatten().map(Vec::len).sum::<usize>();
            match kind {
                Drop | Disconnect | Truncate => assert!(bytes < 400 * 46),
                Delay | Reorder | BitFlips => assert_eq!(bytes, 400 * 46),
                _ => assert!(bytes > 400 * 46),
            }
        }
    }

    #[test]
    fn contract_a_seed_gives_the_same_faults() {
        for kind in [LinkFaultKind::Drop, LinkFaultKind::BitFlips, LinkFaultKind::NoiseBurst] {
            assert_eq!(passed(kind, 0.2, 9), passed(kind, 0.2, 9));
        }
    }
}
