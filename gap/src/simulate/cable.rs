//! The loop of the cable over the gimbal's angle, in four formulations of one initial stiffness and one full torque.
//!
//! ```text
//! Bouc-Wen    torque = t z           dz = dx / d (1 - z^2)              under load, dx / d off it
//! exponential torque = t z           dz = dx / d (1 - |z|)              under load, dx / d off it
//! Dahl        torque = t z           dz = dx / d (1 - |z|)              under load, dx / d (1 + |z|) off it
//! stops       torque = t sum s_i z_i dz_i = dx / d_i,  |z_i| <= 1       d_i = (i - 1/2) 2 d / n,  s_i = d_i / (n d)
//! ```
//!
//! The stops are elasto-slip elements in parallel, alike in their stiffness, whose yields are spread evenly from nothing to
//! the largest. Their stiffness together is `sum s_i / d_i = 1 / d`, as Bouc-Wen's, and their strength is `sum s_i = 1`. From
//! rest they follow `t (x / d - x^2 / (4 d^2))`, which is full at 2 d, and after a reversal twice that of half the way:
//! rounder than Bouc-Wen's line to the middle of the loop.
//!
//! Sources: P. R. Dahl, *A solid friction model*, Aerospace Corporation TOR-0158(3107-18)-1, 1968; Y. K. Wen, *Method for random vibration of hysteretic systems*, J. Eng. Mech. 102 (EM2), 1976; W. D. Iwan, *A
//! distributed-element model for hysteresis and its steady-state dynamic response*, J. Appl. Mech. 33 (4), 1966.

use super::lanes::{Lanes, within};
use super::physics::{Hysteresis, Loop};

/// Stops in parallel.
const COUNT: usize = 6;
/// Rate of each force by the way over the displacement of all, `d / d_i`.
const STIFFNESSES: [f64; COUNT] = [6.0, 2.0, 6.0 / 5.0, 6.0 / 7.0, 2.0 / 3.0, 6.0 / 11.0];
/// What each is of the full torque, `s_i`.
const SHARES: [f64; COUNT] = [1.0 / 36.0, 1.0 / 12.0, 5.0 / 36.0, 7.0 / 36.0, 1.0 / 4.0, 11.0 / 36.0];

/// Force of each stop over the one at which it yields, lane by lane; none where no lane's loop is made of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stops<const L: usize>(Option<[Lanes<L>; COUNT]>);

impl<const L: usize> Stops<L> {
    /// All at one share of their forces, where any of the loops is made of stops.
    pub(super) fn new(mut loops: impl Iterator<Item = Hysteresis>, share: Lanes<L>) -> Self {
        Self(loops.any(|own| own.formulation == Loop::Stops).then_some([share; COUNT]))
    }

    /// Those of one lane.
    #[inline(always)]
    pub(super) fn of(&self, lane: usize) -> Stops<1> {
        Stops(self.0.map(|forces| forces.map(|force| Lanes::all(force[lane]))))
    }

    /// Those of one lane, gone on by themselves.
    #[inline(always)]
    pub(super) fn put(&mut self, lane: usize, one: &Stops<1>) {
        if let (Some(forces), Some(one)) = (&mut self.0, &one.0) {
            forces.iter_mut().zip(one).for_each(|(all, one)| all[lane] = one[0]);
        }
    }
}

impl Hysteresis {
    /// Share of the full torque after the gimbal has turned, from the share z before or from the stops.
    #[inline(always)]
    pub(super) fn after<const L: usize>(&self, lane: usize, z: f64, turned_rad: f64, stops: &mut Stops<L>) -> f64 {
        let moved = turned_rad / self.displacement_rad;
        if let (Loop::Stops, Some(forces)) = (self.formulation, &mut stops.0) {
            let mut share = 0.0;
            for ((force, stiffness), part) in forces.iter_mut().zip(STIFFNESSES).zip(SHARES) {
                force[lane] = within(force[lane] + stiffness * moved, 1.0);
                share += part * force[lane];
            }
            return share;
        }
        let slope = |z: f64| {
            let loads = z * turned_rad > 0.0;
            match self.formulation {
                Loop::Dahl if !loads => 1.0 + z.abs(),
                Loop::Dahl | Loop::Exponential if loads => 1.0 - z.abs(),
                _ if loads => 1.0 - z * z,
                _ => 1.0,
            }
        };
        let half = z + 0.5 * moved * slope(z);
        (z + moved * slope(half)).clamp(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{COUNT, Hysteresis, Lanes, Loop, Stops};

    const ALONG_RAD: f64 = 0.02;

    /// Share of the full torque after each leg of a way of short steps.
    fn shares(formulation: Loop, legs_rad: &[f64]) -> Vec<f64> {
        let cable = Hysteresis { torque_nm: 3e-4, displacement_rad: ALONG_RAD, formulation, wound: 0.0 };
        let (mut share, mut stops) = (0.0, Stops::new([cable].into_iter(), Lanes::<1>::all(0.0)));
        let leg = |leg_rad: &f64| {
            (0..4000).for_each(|_| share = cable.after(0, share, leg_rad / 4000.0, &mut stops));
            share
        };
        legs_rad.iter().map(leg).collect()
    }

    #[test]
    fn closed_form_all_begin_with_one_stiffness_and_end_at_one_torque() {
        for formulation in [Loop::BoucWen, Loop::Stops, Loop::Exponential, Loop::Dahl] {
            let [stiff, full] = shares(formulation, &[0.001 * ALONG_RAD, 9.0 * ALONG_RAD])[..] else {
                panic!("two legs")
            };
            assert!((stiff / 0.001 - 1.0).abs() < 1e-3, "{formulation:?} {stiff}");
            assert!((full - 1.0).abs() < 1e-3, "{formulation:?} {full}");
        }
    }

    #[test]
    fn closed_form_stops_load_along_a_parabola_and_turn_around_at_twice_its_size() {
        let parabola = |x: f64| x - 0.25 * x * x;
        for way in [0.3, 0.8, 1.3, 1.9] {
            let [up, down, back] = shares(Loop::Stops, &[way, -0.7 * way, 0.7 * way].map(|leg| leg * ALONG_RAD))[..]
            else {
                panic!("three legs")
            };
            // the stops' lines are tangents, off by 1 / (4 n^2) at the most; Masing's rule makes twice as much of it
            let least = 0.25 / (COUNT * COUNT) as f64;
            assert!((up - parabola(way)).abs() < 1.01 * least, "{way}: {up}");
            assert!((up - down - 2.0 * parabola(0.35 * way)).abs() < 2.01 * least, "{way}: {up} {down}");
            // a loop within closes
            assert!((back - up).abs() < 1e-12, "{way}: {up} {back}");
        }
    }

    #[test]
    fn closed_form_bouc_wen_loads_as_a_hyperbolic_tangent() {
        let [up] = shares(Loop::BoucWen, &[1.2 * ALONG_RAD])[..] else { panic!("a leg") };
        assert!((up - 1.2_f64.tanh()).abs() < 1e-7, "{up}");
    }

    #[test]
    fn closed_form_exponents_of_one_load_along_an_exponential_and_differ_off_it() {
        let along = |formulation| shares(formulation, &[1.2 * ALONG_RAD, 20.0 * ALONG_RAD, -0.5 * ALONG_RAD]);
        let (line, sprung) = (along(Loop::Exponential), along(Loop::Dahl));
        for loop_of in [&line, &sprung] {
            assert!((loop_of[0] - (1.0 - (-1.2_f64).exp())).abs() < 1e-6, "{loop_of:?}");
        }
        assert!((line[2] - 0.5).abs() < 1e-6 && (sprung[2] - (2.0 * (-0.5_f64).exp() - 1.0)).abs() < 1e-6);
    }

    #[test]
    fn closed_form_stops_come_nearest_to_bouc_wens_outer_loop_at_four_fifths_of_its_displacement() {
        let outer = |formulation, along: f64| {
            let there_and_on: Vec<f64> = [-8.0].into_iter().chain([0.05; 120]).map(|leg| leg * along).collect();
            shares(formulation, &there_and_on)
        };
        let smooth = outer(Loop::BoucWen, ALONG_RAD);
        let apart = |ratio: f64| -> f64 {
            let stops = outer(Loop::Stops, ALONG_RAD / ratio);
            stops.iter().zip(&smooth).map(|(a, b)| (a - b) * (a - b)).sum()
        };
        let nearest =
            (12..20).map(|twentieths| f64::from(twentieths) / 20.0).min_by(|a, b| apart(*a).total_cmp(&apart(*b)));
        assert_eq!(nearest, Some(0.8));
    }
}
