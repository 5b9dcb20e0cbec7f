//! What the computer promises, command by command.

mod bench;

use bench::{Bench, sensor, wobble};
use gimbal_computer::{BUILD, limits, parameters};
use gimbal_servo::{Config, estimator};
use gimbal_wire::{Computer as Bits, Frame, Hello, Identity, LoadEnd, Message, Mode, Outcome, Reset, Run, Telemetry};

#[test]
fn contract_a_computer_says_who_it_is() {
    let mut bench = Bench::new();
    let Message::Identity(Identity { build, model, watchdog_ticks, mode, .. }) =
        bench.ask(Message::Hello(Hello { build: BUILD }))
    else {
        panic!("an identity")
    };
    assert_eq!((build, model, watchdog_ticks, mode), (BUILD, 0, limits::WATCHDOG_TICKS, Mode::Empty));
    let ack = bench.load(&Config::consistent(), &estimator::Config::default());
    let expected = parameters::digest(&parameters::values(&Config::consistent(), &estimator::Config::default()));
    assert_eq!((ack.outcome, ack.model), (Outcome::Done, expected));
    assert_eq!(bench.computer.mode(), Mode::Ready);
}

#[test]
fn contract_parameters_come_back_as_they_went() {
    let mut axis = Config::as_printed();
    axis.bearing.viscous_law = gimbal_servo::bearing::ViscousLaw::Metric;
    axis.gyro.cross_coupling = true;
    axis.interpolation = gimbal_servo::Interpolation::Held;
    let mut settings = estimator::Config::default();
    settings.sensors.stuck_rows = 3;
    settings.sensors.motor_torque_measured = false;
    let values = parameters::values(&axis, &settings);
    assert_eq!(parameters::model(&values), Ok((axis, settings)));
    // Each parameter has a place of its own, and a name.
    for index in 0..parameters::COUNT {
        let mut other = values;
        other[index] = if other[index].to_bits() == 1.0_f64.to_bits() { 0.0 } else { 1.0 };
        assert_ne!(parameters::digest(&other), parameters::digest(&values), "{}", parameters::NAMES[index]);
        assert_ne!(parameters::model(&other), Ok((axis, settings)), "{}", parameters::NAMES[index]);
    }
    let page = include_str!("../../docs/wire.md");
    for (index, name) in parameters::NAMES.iter().enumerate() {
        assert!(page.contains(&format!("{index} `{name}`")), "{name} is not on the page");
    }
    let mut wrong = values;
    wrong[16] = 0.5;
    assert_eq!(parameters::model(&wrong), Err(16));
}

#[test]
fn contract_the_bench_cannot_raise_a_limit() {
    let mut bench = Bench::new();
    let mut wide = Config::consistent();
    wide.range.torque_nm = 0.2;
    assert_eq!(bench.load(&wide, &estimator::Config::default()).outcome, Outcome::AboveLimit);
    assert_eq!(bench.computer.mode(), Mode::Empty);
    assert_eq!(bench.load(&Config::consistent(), &estimator::Config::default()).outcome, Outcome::Done);
    let above = Message::Run(Run { watchdog_ticks: limits::WATCHDOG_TICKS + 1 });
    assert_eq!(bench.command(above).outcome, Outcome::AboveLimit);
    assert_eq!(bench.computer.mode(), Mode::Ready);
    assert_eq!(bench.command(Message::Run(Run { watchdog_ticks: 3 })).outcome, Outcome::Done);
    for k in 0..5 {
        bench.step(wobble(k));
    }
    assert_eq!(bench.clock().mode, Mode::Running);
    assert_eq!(bench.clock().mode, Mode::Running);
    assert_eq!(bench.clock().mode, Mode::Safe);
}

#[test]
fn contract_wrong_models_are_refused_with_their_parameter() {
    let mut bench = Bench::new();
    let mut values = parameters::values(&Config::consistent(), &estimator::Config::default());
    values[17] = 1.5;
    let ack = bench.load_values(&values);
    assert_eq!((ack.outcome, ack.parameter), (Outcome::WrongModel, 17));
    values[17] = -4.0;
    assert_eq!(bench.load_values(&values).outcome, Outcome::WrongModel);
    values[17] = 4.0;
    values[1] = 1e6;
    let ack = bench.load_values(&values);
    assert_eq!((ack.outcome, ack.parameter), (Outcome::WrongModel, u16::MAX), "an unstable loop");
    let ack = bench.command(Message::LoadEnd(LoadEnd { count: 60, digest: 1 }));
    assert_eq!(ack.outcome, Outcome::Incomplete);
    assert_eq!(bench.command(Message::Run(Run { watchdog_ticks: 0 })).outcome, Outcome::WrongMode);
}

#[test]
fn contract_silence_gives_the_safe_output_and_frames_end_it() {
    let mut bench = Bench::started();
    for k in 0..200 {
        assert_eq!(bench.step(wobble(k)).mode, Mode::Running);
    }
    for silent in 1..=40 {
        let estimate = bench.clock();
        let safe = silent >= limits::WATCHDOG_TICKS;
        assert_eq!(estimate.mode, if safe { Mode::Safe } else { Mode::Running }, "{silent}");
        if safe {
            assert_eq!((estimate.gimbal_angle_rad.to_bits(), estimate.bound_rad.to_bits()), (0, 1.0_f32.to_bits()));
        }
    }
    let faults = bench.faults();
    assert_eq!((faults.trips, faults.safe_ticks), (1, 21));
    assert!(faults.computer.contains(Bits::WATCHDOG_TRIPPED));
    let modes: Vec<Mode> = (0..6).map(|k| bench.step(wobble(k)).mode).collect();
    assert_eq!(modes, [Mode::Safe, Mode::Safe, Mode::Safe, Mode::Safe, Mode::Running, Mode::Running]);
    // A board's own clock says the same when the bench's stands still.
    bench.computer.silence();
    assert_eq!(bench.computer.mode(), Mode::Safe);
}

#[test]
fn contract_a_clock_that_comes_again_is_answered_again() {
    let mut bench = Bench::started();
    let first = bench.step(1e-5);
    bench.tick -= 1;
    assert_eq!(bench.clock(), first);
    assert_ne!(bench.step(2e-5), first);
}

#[test]
fn contract_old_and_repeated_frames_are_left_out() {
    let mut bench = Bench::started();
    for k in 0..50 {
        bench.step(wobble(k));
    }
    let old = Frame { sequence: bench.sequence.wrapping_sub(9), tick: bench.tick, message: sensor(5e-3) };
    bench.computer.receive(&old.emit());
    assert_eq!(bench.clock().age, 1, "the last row is held");
    bench.sequence += 1;
    let late = Frame { sequence: bench.sequence, tick: bench.tick - limits::OLDEST_FRAME_TICKS, message: sensor(5e-3) };
    bench.computer.receive(&late.emit());
    assert_eq!(bench.clock().age, 2);
    while bench.tick % limits::TELEMETRY_TICKS != limits::TELEMETRY_TICKS - 1 {
        bench.step(0.0);
    }
    bench.tick += 1;
    bench.send(Message::Clock);
    let answers = bench.answers();
    let Some(Message::Telemetry(Telemetry { stale, held, .. })) = answers.first() else { panic!("{answers:?}") };
    assert_eq!((*stale, *held), (2, 3));
}

#[test]
fn contract_a_flood_is_ignored_and_flagged() {
    let mut bench = Bench::started();
    let quiet = bench.step(1e-5);
    for _ in 0..100 {
        bench.send(Message::ReadFaults);
    }
    let taken = bench.answers().len();
    assert_eq!(taken, usize::from(limits::FRAMES_A_TICK));
    let estimate = bench.clock();
    assert_eq!(estimate.mode, quiet.mode);
    let faults = bench.faults();
    assert_eq!(faults.ignored, 100 - u32::from(limits::FRAMES_A_TICK));
    assert!(faults.computer.contains(Bits::OVERLOADED));
}

#[test]
fn contract_resets_forget_what_they_say() {
    let mut bench = Bench::started();
    let first = bench.step(1e-4);
    bench.step(2e-4);
    assert_eq!(bench.command(Message::Reset(Reset { whole: false })).outcome, Outcome::Done);
    assert_eq!(bench.computer.mode(), Mode::Ready);
    assert_eq!(bench.command(Message::Run(Run { watchdog_ticks: 0 })).outcome, Outcome::Done);
    let again = bench.step(1e-4);
    assert_eq!((again.gimbal_angle_rad, again.flags), (first.gimbal_angle_rad, first.flags));
    assert_eq!(bench.command(Message::Reset(Reset { whole: true })).model, 0);
    assert_eq!(bench.clock().mode, Mode::Empty);
    assert!(bench.faults().computer.contains(Bits::RESTARTED));
}

#[test]
fn contract_the_ring_gives_its_last_rows() {
    let mut bench = Bench::started();
    for k in 0..600 {
        bench.step(wobble(k));
    }
    assert_eq!(bench.command(Message::DumpRing).outcome, Outcome::WrongMode);
    assert_eq!(bench.command(Message::Stop).outcome, Outcome::Done);
    bench.send(Message::DumpRing);
    let answers = bench.answers();
    let rows: Vec<u32> = answers
        .iter()
        .filter_map(|message| if let Message::RingRow(row) = message { Some(row.row) } else { None })
        .collect();
    assert_eq!(rows, (88..600).collect::<Vec<u32>>());
    assert!(matches!(answers.last(), Some(Message::RingEnd(end)) if end.rows == 512 && !end.stopped));
    assert_eq!(bench.answers(), []);
}
