//! Least squares within limits: what the nominal model may do about a difference.

use std::rc::Rc;

/// A direction that the nominal model may move along.
#[derive(Debug, Clone)]
pub struct Nuisance {
    /// Whitened change for one unit.
    pub column: Vec<f64>,
    /// Least and largest move, in units.
    pub limits: (f64, f64),
    /// The effect that this parameter beyond its tolerance is.
    pub name: &'static str,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Directions with their products, for many least squares.
#[derive(Debug, Clone)]
pub struct Projection<'a> {
    nuisances: Vec<&'a Nuisance>,
    /// How far each may still move.
    limits: Vec<(f64, f64)>,
    products: Rc<Vec<Vec<f64>>>,
}

impl<'a> Projection<'a> {
    /// Products of all pairs of directions.
    #[must_use]
    pub fn new(nuisances: Vec<&'a Nuisance>) -> Self {
        let products =
            nuisances.iter().map(|a| nuisances.iter().map(|b| dot(&a.column, &b.column)).collect()).collect();
        let limits = nuisances.iter().map(|nuisance| nuisance.limits).collect();
        Self { nuisances, limits, products: Rc::new(products) }
    }

    /// The same from where the directions have been moved to.
    #[must_use]
    pub fn moved(&self, moves: &[f64]) -> Self {
        let limits = self.limits.iter().zip(moves).map(|((least, most), by)| (least - by, most - by)).collect();
        Self { limits, ..self.clone() }
    }

    /// The directions.
    #[must_use]
    pub fn nuisances(&self) -> &[&'a Nuisance] {
        &self.nuisances
    }

    /// Norm of what is left of a difference after the directions have taken from it what they can within limits.
    #[must_use]
    pub fn left_of(&self, difference: &[f64]) -> f64 {
        self.left_with(difference, &[])
    }

    /// The same with directions beside that have no limits.
    #[must_use]
    pub fn left_with(&self, difference: &[f64], free: &[&[f64]]) -> f64 {
        self.closest(difference, free).1
    }

    /// How far the directions, and those beside that have no limits, move to take most of a difference; and the norm of
    /// what is left of it.
    #[must_use]
    pub fn closest(&self, difference: &[f64], free: &[&[f64]]) -> (Vec<f64>, f64) {
        let fixed = self.nuisances.len();
        let count = fixed + free.len();
        let column = |index: usize| if index < fixed { &self.nuisances[index].column[..] } else { free[index - fixed] };
        let product =
            |a: usize, b: usize| if a < fixed && b < fixed { self.products[a][b] } else { dot(column(a), column(b)) };
        let products: Vec<Vec<f64>> = (0..count).map(|a| (0..count).map(|b| product(a, b)).collect()).collect();
        let pulls: Vec<f64> = (0..count).map(|index| dot(column(index), difference)).collect();
        let mut moves = vec![0.0; count];
        // coordinate descent: the problem is convex, and each pass is a few hundred multiplications
        for _ in 0..4000 {
            let mut largest = 0.0_f64;
            for index in 0..count {
                let own = products[index][index];
                if own <= 1e-12 {
                    continue;
                }
                let others: f64 =
                    products[index].iter().zip(&moves).map(|(a, b)| a * b).sum::<f64>() - own * moves[index];
                let best = (pulls[index] - others) / own;
                let (least, most) = if index < fixed { self.limits[index] } else { (f64::NEG_INFINITY, f64::INFINITY) };
                let moved = best.clamp(least, most);
                largest = largest.max((moved - moves[index]).abs() * own.sqrt());
                moves[index] = moved;
            }
            if largest < 1e-3 {
                break;
            }
        }
        let mut left = dot(difference, difference);
        for a in 0..count {
            left -= 2.0 * moves[a] * pulls[a];
            for b in 0..count {
                left += moves[a] * moves[b] * products[a][b];
            }
        }
        (moves, left.max(0.0).sqrt())
    }
}
