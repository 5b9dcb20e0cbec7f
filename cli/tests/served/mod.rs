//! A flight computer behind a TCP socket, well or badly behaved.

#![allow(dead_code, reason = "no test file uses all of it")]

use std::io::{Read, Write};
use std::net::TcpListener;

use gimbal_bench::link::Host;
use gimbal_wire::{Frame, Message, Receiver};

/// How it behaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ends {
    /// Well.
    Never,
    /// It closes the socket after so many bytes up.
    After(usize),
    /// It says no more after so many bytes up.
    Silent(usize),
    /// From tick 500 on the estimate's last bit is another.
    Lies,
}

/// The computer's address.
pub(crate) struct Served {
    pub(crate) address: String,
}

/// Serves one bench.
pub(crate) fn serve(ends: Ends) -> Served {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    std::thread::spawn(move || {
        let (mut socket, _) = listener.accept().expect("a bench");
        socket.set_nodelay(true).expect("set");
        let (mut host, mut said, mut buffer) = (Host::new(), 0, [0; 4096]);
        while let Ok(count) = socket.read(&mut buffer) {
            let mut answers = Vec::new();
            host.answer(&buffer[..count], &mut answers);
            match ends {
                Ends::After(most) if said >= most => return,
                Ends::Silent(most) if said >= most => answers.clear(),
                Ends::Lies => answers = lie(&answers),
                _ => {}
            }
            said += answers.len();
            if count == 0 || socket.write_all(&answers).is_err() {
                return;
            }
        }
    });
    Served { address }
}

fn lie(answers: &[u8]) -> Vec<u8> {
    let mut receiver = Receiver::default();
    let frames = answers.iter().filter_map(|byte| receiver.push(*byte));
    let changed = frames.flat_map(|mut frame: Frame| {
        if let Message::Estimate(estimate) = &mut frame.message
            && frame.tick >= 500
        {
            estimate.innovation_rad = f32::from_bits(estimate.innovation_rad.to_bits() ^ 1);
        }
        frame.emit()
    });
    changed.collect()
}
