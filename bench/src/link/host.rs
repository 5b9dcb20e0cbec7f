//! A computer in the bench's own process, behind the same frames.

use std::time::Duration;

use gimbal_computer::Computer;

use super::{Link, LinkError};

/// The flight code in process.
#[derive(Default)]
pub struct Host {
    computer: Box<Computer<f32>>,
    waiting: Vec<u8>,
}

impl Host {
    /// After power-on.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes bytes; appends the answers.
    pub fn answer(&mut self, bytes: &[u8], answers: &mut Vec<u8>) {
        for &byte in bytes {
            if self.computer.receive_byte(byte) {
                while let Some(frame) = self.computer.take() {
                    answers.extend_from_slice(&frame);
                }
            }
        }
    }
}

impl Link for Host {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        let mut waiting = std::mem::take(&mut self.waiting);
        self.answer(bytes, &mut waiting);
        self.waiting = waiting;
        Ok(())
    }

    fn receive(&mut self, bytes: &mut Vec<u8>, _wait: Duration) -> Result<(), LinkError> {
        bytes.append(&mut self.waiting);
        Ok(())
    }

    fn describe(&self) -> String {
        "flight code in the bench's own process".to_owned()
    }
}
