//! Noise of low frequency that is taken for a sensor's: few lines of a log show it, and an unknown effect as slow is in it.

use crate::fit::Problem;

/// Slow noise over the white one, in amplitude, from which on it is told.
const MUCH: f64 = 10.0;

/// What is told of the channels that have much of it.
pub(crate) fn slow_noise(problem: &Problem) -> Vec<String> {
    let channels = problem.record.channels.iter().zip(&problem.whitener.noise);
    let told = |(channel, noise): (&crate::record::Channel, &crate::fit::Noise)| {
        let [times, end_hz] = noise.slow_over_white().filter(|[times, _]| *times > MUCH)?;
        let column = channel.signal.column().name();
        Some(format!(
            "{column}: below {end_hz:.1} Hz up to {times:.0} times its white noise is taken for the sensor's; an unknown effect as slow would be in that"
        ))
    };
    channels.filter_map(told).collect()
}
