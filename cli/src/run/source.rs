//! Rows of a log as inputs at a constant rate, read in a thread of its own.
//!
//! Rows that are missing are put on the straight line between their neighbours, which is what the model takes inputs
//! to be; rows that repeat a time stamp are left out; a missing sample is the last one known. All are counted.

use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use gimbal_log::{Batch, Column, LogError, Needs, Reader, Row, TimeReport};
use gimbal_servo::Input;

use super::model::Drive;
use crate::exit::Failure;
use crate::progress::Watched;

/// Rows handed over at once.
const PORTION_ROWS: usize = 1024;
/// Portions under way.
const PORTIONS: usize = 4;
/// Gaps up to this length are filled [s].
const LONGEST_GAP_S: f64 = 1.0;
/// Periods that the law can be built for [s].
const PERIODS_S: std::ops::RangeInclusive<f64> = 0.25e-3..=4e-3;
/// Columns that drive the model, the last one `cross_axis_coupling` alone.
const DRIVING: [Column; 5] = [Column::AccelX, Column::AccelY, Column::AccelZ, Column::VehicleRate, Column::CrossRate];

/// Consecutive inputs, with the rows that they come from.
#[derive(Debug)]
pub(crate) struct Portion {
    pub(crate) times_s: Vec<f64>,
    pub(crate) inputs: Vec<Drive>,
    /// Row of the batch behind each input; none for one that was filled in.
    pub(crate) rows: Vec<Option<u32>>,
    pub(crate) batch: Batch,
}

/// What was done to a log to get constant-rate inputs from it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Mended {
    pub(crate) time: TimeReport,
    pub(crate) filled_rows: u64,
    pub(crate) left_out_rows: u64,
    pub(crate) missing_samples: u64,
}

/// A log under way.
pub(crate) struct Source {
    pub(crate) period_s: f64,
    pub(crate) remarks: Vec<String>,
    /// Columns of the contract that the log has.
    pub(crate) columns: Vec<Column>,
    pub(crate) extra_names: Vec<String>,
    full: Receiver<Result<Portion, LogError>>,
    empty: SyncSender<Portion>,
    thread: JoinHandle<Mended>,
}

impl Source {
    /// Opens a log and finds its rate; `takes_cross_rate` where the vehicle rate about x acts, if the log has it.
    pub(crate) fn open(path: &Path, keeps_extras: bool, takes_cross_rate: bool) -> Result<Self, Failure> {
        let unreadable = |error| LogError::unreadable(path, error);
        let file = Watched::open(path).map_err(unreadable)?;
        let mut reader = Reader::new(file, path, Needs::Run)?;
        let mut first = Portion::new(keeps_extras);
        reader.next_batch(&mut first.batch)?;
        let period_s = period_s(path, &reader.time())?;
        let layout = reader.layout();
        let columns: Vec<Column> =
            Column::ALL.into_iter().filter(|column| layout.position(*column).is_some()).collect();
        let extra_names = layout.extra_names().map(str::to_owned).collect();
        let remarks = reader.remarks().to_vec();

        let (fill, full) = sync_channel(PORTIONS);
        let (empty, drained) = sync_channel(PORTIONS);
        for _ in 1..PORTIONS {
            let _ = empty.send(Portion::new(keeps_extras));
        }
        let driving =
            if takes_cross_rate && columns.contains(&Column::CrossRate) { &DRIVING[..] } else { &DRIVING[..4] };
        let mend = Mend { period_s, driving, last: None, last_inputs: [0.0; 5], mended: Mended::default() };
        let thread = std::thread::spawn(move || pump(reader, first, mend, &fill, &drained));
        Ok(Self { period_s, remarks, columns, extra_names, full, empty, thread })
    }

    /// The next inputs, or `None` behind the last.
    pub(crate) fn next(&self) -> Result<Option<Portion>, Failure> {
        match self.full.recv() {
            Ok(portion) => Ok(Some(portion?)),
            Err(_) => Ok(None),
        }
    }

    /// Takes a portion back.
    pub(crate) fn give_back(&self, portion: Portion) {
        // Nobody waits for it behind the last row.
        let _ = self.empty.send(portion);
    }

    /// What was done to the log, all of it read.
    pub(crate) fn finish(self) -> Mended {
        drop(self.empty);
        drop(self.full);
        self.thread.join().unwrap_or_default()
    }
}

impl Portion {
    fn new(keeps_extras: bool) -> Self {
        Self {
            times_s: Vec::with_capacity(PORTION_ROWS),
            inputs: Vec::with_capacity(PORTION_ROWS),
            rows: Vec::with_capacity(PORTION_ROWS),
            batch: Batch::new(PORTION_ROWS, keeps_extras),
        }
    }

    fn push(&mut self, time_s: f64, [x, y, z, rate, cross_rate_radps]: [f64; 5], row: Option<u32>) {
        self.times_s.push(time_s);
        self.rows.push(row);
        let input = Input {
            accel_x_mps2: x,
            accel_y_mps2: y,
            accel_z_mps2: z,
            vehicle_rate_radps: rate,
            torque_nm: 0.0,
            spin_rate_radps: 0.0,
        };
        self.inputs.push(Drive { input, cross_rate_radps });
    }
}

/// The period of the law for a log: exactly 1 ms where it is that but for rounding.
fn period_s(path: &Path, time: &TimeReport) -> Result<f64, Failure> {
    let file = path.display();
    if time.rows < 2 {
        return Err(Failure::input(format!("{file}: there is one row; a run needs two")));
    }
    if (time.period_s - 1e-3).abs() < 5e-6 {
        return Ok(1e-3);
    }
    if PERIODS_S.contains(&time.period_s) {
        return Ok(time.period_s);
    }
    Err(Failure::input(format!(
        "{file}: column `time_s`: the rate is {:.6} Hz and the model runs at 250 to 4000 Hz; resample it: `gimbal \
         convert {file} --rate-hz 1000 --out FILE.csv`",
        time.rate_hz()
    )))
}

/// Turns rows into inputs.
struct Mend {
    period_s: f64,
    driving: &'static [Column],
    last: Option<(f64, [f64; 5])>,
    /// Last known sample of each driving column.
    last_inputs: [f64; 5],
    mended: Mended,
}

impl Mend {
    /// Inputs from the rows of the portion's batch.
    fn take(&mut self, portion: &mut Portion, path: &Path) -> Result<(), LogError> {
        portion.times_s.clear();
        portion.inputs.clear();
        portion.rows.clear();
        for index in 0..portion.batch.rows().len() {
            let row = portion.batch.rows()[index];
            let line = portion.batch.lines()[index];
            let time_s = row[Column::Time];
            let inputs = self.inputs(&row).map_err(|column| LogError::starts_missing(path, line, column))?;
            if let Some((from_s, from)) = self.last {
                let periods = (time_s - from_s) / self.period_s;
                if periods < 0.5 {
                    self.mended.left_out_rows += 1;
                    continue;
                }
                if periods >= 1.5 {
                    if time_s - from_s > LONGEST_GAP_S {
                        return Err(LogError::gap(path, line, from_s, time_s));
                    }
                    self.fill(portion, (from_s, from), (time_s, inputs), periods.round());
                }
            }
            portion.push(time_s, inputs, u32::try_from(index).ok());
            self.last = Some((time_s, inputs));
        }
        Ok(())
    }

    /// The driving samples of a row, missing ones as they were last; the column that never had one.
    fn inputs(&mut self, row: &Row) -> Result<[f64; 5], Column> {
        for (last, &column) in self.last_inputs.iter_mut().zip(self.driving) {
            let value = row[column];
            if value.is_nan() {
                self.mended.missing_samples += 1;
                if self.last.is_none() {
                    return Err(column);
                }
            } else {
                *last = value;
            }
        }
        Ok(self.last_inputs)
    }

    /// Inputs on the line between two rows.
    fn fill(&mut self, portion: &mut Portion, from: (f64, [f64; 5]), to: (f64, [f64; 5]), periods: f64) {
        let mut step = 1.0;
        while step < periods {
            let share = step / periods;
            let line = |from: f64, to: f64| from + share * (to - from);
            let inputs = std::array::from_fn(|i| line(from.1[i], to.1[i]));
            portion.push(line(from.0, to.0), inputs, None);
            self.mended.filled_rows += 1;
            step += 1.0;
        }
    }
}

/// Reads until the end, an error, or nobody listens.
fn pump(
    mut reader: Reader<Watched>,
    first: Portion,
    mut mend: Mend,
    fill: &SyncSender<Result<Portion, LogError>>,
    drained: &Receiver<Portion>,
) -> Mended {
    let path = reader.file().to_owned();
    let mut portion = first;
    loop {
        let taken = mend.take(&mut portion, &path);
        let failed = taken.is_err();
        if fill.send(taken.map(|()| portion)).is_err() || failed {
            break;
        }
        let Ok(next) = drained.recv() else { break };
        portion = next;
        if let Err(error) = reader.next_batch(&mut portion.batch) {
            let _ = fill.send(Err(error));
            break;
        }
        if portion.batch.rows().is_empty() {
            break;
        }
    }
    Mended { time: reader.time(), ..mend.mended }
}
