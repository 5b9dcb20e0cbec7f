//! What micromath's sine, cosine and root would cost the platform: largest errors over a full turn.
//!
//! ```text
//! cargo run --release -p host-tests --example micromath
//! ```

use micromath::F32Ext;

const ANGLES: u32 = 1_000_000;

#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "the crate takes f32")]
fn main() {
    let mut worst = [0.0_f64; 4];
    for k in 0..=ANGLES {
        let angle = std::f64::consts::PI * (2.0 * f64::from(k) / f64::from(ANGLES) - 1.0);
        let single = angle as f32;
        let (sine, cosine) = (f64::from(single).sin(), f64::from(single).cos());
        let (s, c) = (f64::from(F32Ext::sin(single)), f64::from(F32Ext::cos(single)));
        // The root of a square that goes from 1 to 4, as its vectors' magnitude takes it.
        let square = 1.0 + 3.0 * k as f32 / ANGLES as f32;
        let root = f64::from(F32Ext::sqrt(square)) / f64::from(square).sqrt() - 1.0;
        let errors = [s - sine, c - cosine, (s - sine).hypot(c - cosine), root];
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error.abs());
        }
    }
    let [sine, cosine, turned, root] = worst;
    println!("micromath, largest errors over a full turn:");
    println!("  sine                         {sine:.2e}");
    println!("  cosine                       {cosine:.2e}");
    println!("  a vector of length 1, turned {turned:.2e}");
    println!("  a magnitude, relative        {root:.2e}");
}
