//! The product of two words with all its bits.
//!
//! Armv6-M has no instruction for it, and the run-time library multiplies 64 by 64 bits: 42 instructions and the call. Here it
//! is made of halves, the same bits in 17.

/// `left * right`.
#[cfg(not(all(target_arch = "arm", not(target_has_atomic = "32"))))]
#[inline(always)]
pub(super) fn product(left: i32, right: i32) -> i64 {
    i64::from(left) * i64::from(right)
}

/// `left * right`. Of Arm's cores those without compare-and-swap are Armv6-M.
#[cfg(all(target_arch = "arm", not(target_has_atomic = "32")))]
#[inline(always)]
pub(super) fn product(left: i32, right: i32) -> i64 {
    of_halves(left, right)
}

/// Knuth's multiplication of two digits (*The Art of Computer Programming*, 4.3.1), the upper ones with a sign: no partial
/// sum leaves its word.
#[cfg(any(test, all(target_arch = "arm", not(target_has_atomic = "32"))))]
#[inline(always)]
#[allow(clippy::cast_sign_loss, clippy::cast_possible_wrap, reason = "halves of words")]
fn of_halves(left: i32, right: i32) -> i64 {
    let (left_low, right_low) = (left & 0xFFFF, right & 0xFFFF);
    let (left_high, right_high) = (left >> 16, right >> 16);
    let carried = ((left_low.wrapping_mul(right_low) as u32) >> 16) as i32;
    let first = left_high.wrapping_mul(right_low).wrapping_add(carried);
    let second = left_low.wrapping_mul(right_high).wrapping_add(first & 0xFFFF);
    let upper = left_high.wrapping_mul(right_high).wrapping_add(first >> 16).wrapping_add(second >> 16);
    i64::from(upper) << 32 | i64::from(left.wrapping_mul(right) as u32)
}

#[cfg(test)]
mod tests {
    use super::{of_halves, product};

    #[test]
    fn closed_form_halves_make_the_whole_product() {
        let edges = [i32::MIN, i32::MIN + 1, -65_537, -65_536, -65_535, -32_769, -32_768, -2, -1];
        let mut words: [i32; 4_000] = [0; 4_000];
        let mut seed = 1_u32;
        for (i, word) in words.iter_mut().enumerate() {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let random = i32::from_le_bytes(seed.to_le_bytes()) >> (i % 31);
            *word = edges.get(i / 2).map_or(random, |edge| if i % 2 == 0 { *edge } else { !*edge });
        }
        for (i, &left) in words.iter().enumerate() {
            for &right in &words[..i.min(600)] {
                let exact = i64::from(left) * i64::from(right);
                assert_eq!(of_halves(left, right), exact, "{left} * {right}");
                assert_eq!(product(left, right), exact);
            }
        }
    }
}
