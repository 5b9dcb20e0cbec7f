//! Sums over long series, with the widest vectors that there are. Four partial sums each, so that the order of a sum is
//! the same with all.

use pulp::{Arch, Simd, WithSimd};

/// Partial sums of a product.
const SUMS: usize = 4;

/// `a . b`.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let [[sum]] = Arch::new().dispatch(Block { a: [a], b: [b] });
    sum
}

/// `x <- x - share (a . x) a`.
pub(super) fn take_along(x: &mut [f64], a: &[f64], share: f64) {
    Arch::new().dispatch(Along { by: share * dot(a, x), x, a });
}

/// Products of four columns with two.
pub(super) fn four_by_two(a: [&[f64]; 4], b: [&[f64]; 2]) -> [[f64; 2]; 4] {
    Arch::new().dispatch(Block { a, b })
}

struct Block<'a, const A: usize, const B: usize> {
    a: [&'a [f64]; A],
    b: [&'a [f64]; B],
}

impl<const A: usize, const B: usize> WithSimd for Block<'_, A, B> {
    type Output = [[f64; B]; A];

    #[inline(always)]
    #[allow(clippy::needless_range_loop, reason = "place by place, as the compiler's vectors have it")]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let rows = self.a[0].len();
        let (a, b) = (self.a.map(|own| &own[..rows]), self.b.map(|own| &own[..rows]));
        let whole = rows / SUMS;
        let (left, right) = (a.map(|own| &own.as_chunks().0[..whole]), b.map(|own| &own.as_chunks().0[..whole]));
        let mut sums = [[[0.0; SUMS]; B]; A];
        for k in 0..whole {
            for j in 0..B {
                let right: [f64; SUMS] = right[j][k];
                for i in 0..A {
                    let left: [f64; SUMS] = left[i][k];
                    for place in 0..SUMS {
                        sums[i][j][place] += left[place] * right[place];
                    }
                }
            }
        }
        let mut out = [[0.0; B]; A];
        for i in 0..A {
            for j in 0..B {
                let rest: f64 = (whole * SUMS..rows).map(|k| a[i][k] * b[j][k]).sum();
                out[i][j] = sums[i][j].iter().sum::<f64>() + rest;
            }
        }
        out
    }
}

struct Along<'a> {
    x: &'a mut [f64],
    a: &'a [f64],
    by: f64,
}

impl WithSimd for Along<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (x, a) in self.x.iter_mut().zip(self.a) {
            *x -= self.by * a;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{dot, four_by_two, take_along};

    #[test]
    fn closed_form_sums_of_whole_numbers_are_exact() {
        let series = |first: u32| -> Vec<f64> { (0..37).map(|k| f64::from((first + k) % 11)).collect() };
        let columns: Vec<Vec<f64>> = (0..6).map(series).collect();
        let plain = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|index: usize| columns[index].as_slice());
        let products = four_by_two([a, b, c, d], [e, f]);
        for (row, left) in products.iter().zip([a, b, c, d]) {
            assert_eq!(row.map(f64::to_bits), [plain(left, e), plain(left, f)].map(f64::to_bits));
        }
        assert_eq!(dot(a, b).to_bits(), plain(a, b).to_bits());
        let mut x = a.to_vec();
        take_along(&mut x, a, 1.0 / plain(a, a));
        assert!(x.iter().all(|value| value.abs() < 1e-13), "{x:?}");
    }
}
