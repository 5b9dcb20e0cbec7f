//! Whitening: all channels together through a vector autoregression, fitted to what no effect explains.
//!
//! ```text
//! w_k = L^-1 (e_k - A_1 e_(k-1) - ... - A_p e_(k-p))        L L' the covariance of the innovation
//! ```
//!
//! Windows with the largest energy are left out of the fit, so that what happens now and then is no noise.

use nalgebra::{Cholesky, DMatrix};

/// p.
const ORDER: usize = 12;
/// Rows of a window.
const WINDOW: usize = 400;
/// Share of the windows, the quietest, that the noise is taken from.
const QUIET: f64 = 0.75;

/// A whitening filter.
#[derive(Debug, Clone)]
pub struct Whitener {
    channels: usize,
    /// For each lag from 0: the matrix that acts on the sample, row by row.
    taps: Vec<Vec<f64>>,
    /// Rows that count.
    pub valid: Vec<bool>,
    /// Weight of each row: noise that comes in bursts counts less where it does.
    pub weight: Vec<f64>,
}

/// Rows to either side over which the local power is taken.
const AROUND: usize = 30;

impl Whitener {
    /// Fits the filter to a residual, channel by channel.
    #[must_use]
    pub fn new(residual: &[Vec<f64>], valid: &[bool]) -> Self {
        let channels = residual.len();
        let size = channels * (ORDER + 1);
        let rows = valid.len();
        // covariance of the stacked past, window by window
        let mut windows: Vec<(f64, DMatrix<f64>)> = Vec::new();
        let mut start = ORDER;
        let stride = (rows / 12_000).max(1);
        while start + WINDOW <= rows {
            if valid[start - ORDER..start + WINDOW].iter().all(|valid| *valid) {
                let picks: Vec<usize> = (start..start + WINDOW).step_by(stride).collect();
                let stacked = DMatrix::from_fn(size, picks.len(), |place, column| {
                    residual[place % channels][picks[column] - place / channels]
                });
                let covariance = &stacked * stacked.transpose() / picks.len() as f64;
                windows.push(((0..channels).map(|c| covariance[(c, c)]).sum(), covariance));
            }
            start += WINDOW;
        }
        windows.sort_by(|a, b| a.0.total_cmp(&b.0));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let kept = ((windows.len() as f64 * QUIET) as usize).max(1).min(windows.len());
        let mut covariance = DMatrix::identity(size, size) * 1e-9;
        for (_, window) in &windows[..kept] {
            covariance += window / kept as f64;
        }
        if windows.is_empty() {
            covariance += DMatrix::identity(size, size);
        }
        let mut whitener = Self::from_covariance(channels, &covariance);
        whitener.valid = (0..rows).map(|k| k >= ORDER && valid[k - ORDER..=k].iter().all(|valid| *valid)).collect();
        whitener.weight = vec![1.0; rows];
        let white = whitener.apply(residual);
        whitener.weight = whitener.local(&white);
        whitener
    }

    fn from_covariance(channels: usize, covariance: &DMatrix<f64>) -> Self {
        let past = covariance.nrows() - channels;
        let identity = DMatrix::identity(channels, channels);
        let own = covariance.view((0, 0), (channels, channels)).into_owned();
        let cross = covariance.view((0, channels), (channels, past)).into_owned();
        let mut inner = covariance.view((channels, channels), (past, past)).into_owned();
        let ridge = 1e-6 * inner.trace() / past as f64;
        inner += DMatrix::identity(past, past) * ridge;
        let gains = Cholesky::new(inner)
            .map_or_else(|| DMatrix::zeros(channels, past), |c| c.solve(&cross.transpose()).transpose());
        let innovation = &own - &gains * cross.transpose();
        let lower = Cholesky::new((&innovation + innovation.transpose()) * 0.5).map_or(identity.clone(), |c| c.l());
        let scale = lower.try_inverse().unwrap_or(identity);
        let flat = |matrix: &DMatrix<f64>| -> Vec<f64> { matrix.transpose().iter().copied().collect() };
        let mut taps = vec![flat(&scale)];
        for lag in 0..ORDER {
            let gain = gains.view((0, lag * channels), (channels, channels)).into_owned();
            taps.push(flat(&(-(&scale * gain))));
        }
        Self { channels, taps, valid: Vec::new(), weight: Vec::new() }
    }

    /// Weights that bring a whitened residual down to unit power everywhere.
    #[must_use]
    pub fn local(&self, white: &[f64]) -> Vec<f64> {
        let (channels, rows) = (self.channels, self.valid.len());
        let mut sums = vec![(0.0, 0.0); rows + 1];
        for k in 0..rows {
            let power: f64 = white[k * channels..(k + 1) * channels].iter().map(|value| value * value).sum();
            let count = if self.valid[k] { channels as f64 } else { 0.0 };
            sums[k + 1] = (sums[k].0 + power, sums[k].1 + count);
        }
        // 1.0 and three standard errors of the mean: quiet noise keeps its weight
        let quiet = 1.0 + 3.0 * (2.0 / (channels as f64 * (2 * AROUND + 1) as f64)).sqrt();
        (0..rows)
            .map(|k| {
                let (from, to) = (k.saturating_sub(AROUND), (k + AROUND + 1).min(rows));
                let count = sums[to].1 - sums[from].1;
                let power = if count > 0.0 { (sums[to].0 - sums[from].0) / count } else { 1.0 };
                if power > quiet { (1.0 / power).sqrt() } else { 1.0 }
            })
            .collect()
    }

    /// The whitened samples of all channels, row after row; masked rows are zero.
    #[must_use]
    pub fn apply(&self, signals: &[Vec<f64>]) -> Vec<f64> {
        let (channels, rows) = (self.channels, signals[0].len());
        let mut out = vec![0.0; channels * rows];
        for to in 0..channels {
            for from in 0..channels {
                let taps: Vec<f64> = self.taps.iter().map(|tap| tap[to * channels + from]).collect();
                let signal = &signals[from];
                for k in ORDER..rows {
                    let past = &signal[k - ORDER..=k];
                    let sum: f64 = past.iter().rev().zip(&taps).map(|(sample, tap)| sample * tap).sum();
                    out[k * channels + to] += sum;
                }
            }
        }
        for (k, valid) in self.valid.iter().enumerate().take(rows) {
            if !valid {
                out[k * channels..(k + 1) * channels].fill(0.0);
            } else if self.weight[k] < 1.0 {
                for value in &mut out[k * channels..(k + 1) * channels] {
                    *value *= self.weight[k];
                }
            }
        }
        out
    }

    /// Samples that count.
    #[must_use]
    pub fn count(&self) -> usize {
        self.channels * self.valid.iter().filter(|valid| **valid).count()
    }
}
