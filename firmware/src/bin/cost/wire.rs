//! Frames between bench and computer: one made and stuffed, and one taken byte by byte, checked and parsed. All frames
//! have one length, so the count is that of any; the number system plays no part.

use crate::tally::Tally;
use core::hint::black_box;
use gimbal_firmware::counter::Counter;
use gimbal_firmware::frames;
use gimbal_wire::{FRAME_LEN, Frame, Message, Receiver, Sensor};

const FRAMES: u16 = 200;

#[inline(never)]
pub(crate) fn count(counter: &mut Counter, number: &str) -> Result<(), &'static str> {
    let mut receiver = Receiver::default();
    let [mut emit, mut receive] = [Tally::EMPTY; 2];
    for k in 0..FRAMES {
        let value = f32::from(k);
        let message = Message::Sensor(Sensor {
            accel_mps2: [0.1 * value, 9.8, -value],
            vehicle_rate_radps: 0.05,
            gyro_angle_rad: Some(1e-5 * value),
            motor_torque_nm: Some(0.0),
        });
        let frame = black_box(Frame { sequence: k, tick: u32::from(k), message });
        let mut bytes = [0; FRAME_LEN];
        emit.add(counter.count(|| bytes = frame.emit()));
        let bytes = black_box(bytes);
        let mut came = None;
        receive.add(counter.count(|| came = frames::receive(&mut receiver, &bytes)));
        if black_box(came) != Some(frame) {
            return Err("a frame does not come back as it was");
        }
    }
    emit.print("cost", "wire-emit", number);
    receive.print("cost", "wire-receive", number);
    Ok(())
}
