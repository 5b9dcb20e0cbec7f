//! Sums over long series, with the widest vectors that there are: in partial sums whose number is the same with all, and
//! so is their order.

use pulp::{Arch, Simd, WithSimd};

/// Partial sums of each of several products, and of one.
const SUMS: usize = 4;
const SUMS_OF_ONE: usize = 16;

/// A sample: whitened columns are kept in single precision, sums are not.
pub(crate) trait Sample: Copy + Into<f64> + Send + Sync {}

impl Sample for f32 {}
impl Sample for f64 {}

/// `a . b`.
pub(super) fn dot(a: &[f32], b: &[f64]) -> f64 {
    let [[sum]] = Arch::new().dispatch(Block::<_, _, 1, 1, SUMS_OF_ONE> { a: [a], b: [b] });
    sum
}

/// `x <- x - share (a . x) a`.
pub(super) fn take_along(x: &mut [f64], a: &[f32], share: f64) {
    Arch::new().dispatch(Along { by: share * dot(a, x), x, a });
}

/// Products of four columns with two.
pub(super) fn four_by_two<T: Sample, U: Sample>(a: [&[T]; 4], b: [&[U]; 2]) -> [[f64; 2]; 4] {
    Arch::new().dispatch(Block::<_, _, 4, 2, SUMS> { a, b })
}

struct Block<'a, T, U, const A: usize, const B: usize, const S: usize> {
    a: [&'a [T]; A],
    b: [&'a [U]; B],
}

impl<T: Sample, U: Sample, const A: usize, const B: usize, const S: usize> WithSimd for Block<'_, T, U, A, B, S> {
    type Output = [[f64; B]; A];

    #[inline(always)]
    #[allow(clippy::needless_range_loop, reason = "place by place, as the compiler's vectors have it")]
    fn with_simd<V: Simd>(self, _: V) -> Self::Output {
        let rows = self.a[0].len();
        let (a, b) = (self.a.map(|own| &own[..rows]), self.b.map(|own| &own[..rows]));
        let whole = rows / S;
        let left = a.map(|own| &own.as_chunks::<S>().0[..whole]);
        let right = b.map(|own| &own.as_chunks::<S>().0[..whole]);
        let mut sums = [[[0.0; S]; B]; A];
        for k in 0..whole {
            for j in 0..B {
                for i in 0..A {
                    for place in 0..S {
                        let sum = &mut sums[i][j][place];
                        *sum = left[i][k][place].into().mul_add(right[j][k][place].into(), *sum);
                    }
                }
            }
        }
        let mut out = [[0.0; B]; A];
        for i in 0..A {
            for j in 0..B {
                let rest: f64 = (whole * S..rows).map(|k| a[i][k].into() * b[j][k].into()).sum();
                out[i][j] = sums[i][j].iter().sum::<f64>() + rest;
            }
        }
        out
    }
}

struct Along<'a> {
    x: &'a mut [f64],
    a: &'a [f32],
    by: f64,
}

impl WithSimd for Along<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (x, a) in self.x.iter_mut().zip(self.a) {
            *x -= self.by * f64::from(*a);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{dot, four_by_two, take_along};

    #[test]
    fn closed_form_sums_of_whole_numbers_are_exact() {
        let series = |first: u16| -> Vec<f32> { (0..37).map(|k| f32::from((first + k) % 11)).collect() };
        let columns: Vec<Vec<f32>> = (0..6).map(series).collect();
        let plain = |a: &[f32], b: &[f32]| -> f64 { a.iter().zip(b).map(|(a, b)| f64::from(a * b)).sum() };
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|index: usize| columns[index].as_slice());
        let products = four_by_two([a, b, c, d], [e, f]);
        for (row, left) in products.iter().zip([a, b, c, d]) {
            assert_eq!(row.map(f64::to_bits), [plain(left, e), plain(left, f)].map(f64::to_bits));
        }
        let mut x: Vec<f64> = a.iter().copied().map(f64::from).collect();
        assert_eq!(dot(b, &x).to_bits(), plain(a, b).to_bits());
        take_along(&mut x, a, 1.0 / plain(a, a));
        assert!(x.iter().all(|value| value.abs() < 1e-13), "{x:?}");
    }
}
