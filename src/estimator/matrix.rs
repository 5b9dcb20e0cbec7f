//! Small matrices in f64, for the filter's gains when the law is built.

/// A square matrix, row by row.
pub(crate) type Square<const L: usize> = [[f64; L]; L];

/// `a b`.
pub(crate) fn product<const L: usize>(a: &Square<L>, b: &Square<L>) -> Square<L> {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..L).map(|k| a[i][k] * b[k][j]).sum()))
}

/// `a p a^T`.
pub(crate) fn congruence<const L: usize>(a: &Square<L>, p: &Square<L>) -> Square<L> {
    let left = product(a, p);
    core::array::from_fn(|i| core::array::from_fn(|j| (0..L).map(|k| left[i][k] * a[j][k]).sum()))
}

/// `e^a`: a Taylor series of a part of a that is small, squared up again.
pub(crate) fn exponential<const L: usize>(a: &Square<L>) -> Square<L> {
    const HALVINGS: i32 = 10;
    let small = a.map(|row| row.map(|x| libm::ldexp(x, -HALVINGS)));
    let (mut term, mut change) = (small, small);
    for order in 2..10 {
        term = product(&term, &small).map(|row| row.map(|x| x / f64::from(order)));
        add(&mut change, &term);
    }
    for _ in 0..HALVINGS {
        let square = product(&change, &change);
        // (1 + c)^2 - 1
        for (row, more) in change.iter_mut().zip(&square) {
            for (entry, more) in row.iter_mut().zip(more) {
                *entry = 2.0 * *entry + more;
            }
        }
    }
    for (place, row) in change.iter_mut().enumerate() {
        row[place] += 1.0;
    }
    change
}

/// `a += b`.
pub(crate) fn add<const L: usize>(a: &mut Square<L>, b: &Square<L>) {
    for (row, more) in a.iter_mut().zip(b) {
        for (entry, more) in row.iter_mut().zip(more) {
            *entry += more;
        }
    }
}
