//! The examples of `docs/wire.md`: `cargo run -p gimbal-wire --example page`.

use gimbal_wire::{Frame, Message, Run, Sensor};

fn main() {
    let sensor = Sensor {
        accel_mps2: [0.0, 196.133, 9.806_65],
        vehicle_rate_radps: 0.1,
        gyro_angle_rad: Some(1.25e-3),
        motor_torque_nm: None,
    };
    let frames = [
        Frame { sequence: 7, tick: 1_000, message: Message::Run(Run { watchdog_ticks: 20 }) },
        Frame { sequence: 258, tick: 70_000, message: Message::Sensor(sensor) },
    ];
    for frame in frames {
        let hex: Vec<String> = frame.emit().iter().map(|byte| format!("{byte:02x}")).collect();
        println!("    hex: {}\n    says: {frame:?}\n", hex.join(" "));
    }
}
