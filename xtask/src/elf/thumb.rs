//! As much of the Thumb instruction set as shows where code goes and how far the stack grows
//! (Armv7-M Architecture Reference Manual, A5 to A7).

use super::code::{Effect, Step};

/// The instruction at `address`, whose bytes come first in `code`.
pub(super) fn decode(code: &[u8], address: u32) -> Option<Step> {
    let first = half(code, 0)?;
    if first >> 11 < 0b11101 {
        return Some(Step { bytes: 2, effect: narrow(first, address) });
    }
    let second = half(code, 2)?;
    Some(Step { bytes: 4, effect: wide(first, second, address) })
}

fn half(code: &[u8], at: usize) -> Option<u32> {
    Some(u32::from(u16::from_le_bytes(code.get(at..at + 2)?.try_into().ok()?)))
}

/// Instructions of 16 bits.
fn narrow(op: u32, address: u32) -> Effect {
    match op {
        // push: registers, and the link register in bit 8
        _ if op & 0xFE00 == 0xB400 => Effect::Grow(4 * (op & 0x1FF).count_ones()),
        // sub sp, #imm
        _ if op & 0xFF80 == 0xB080 => Effect::Grow(4 * (op & 0x7F)),
        // add sp, rm and sub by way of it: large frames of Armv6-M
        _ if op & 0xFF87 == 0x4485 => Effect::Unknown("sp changed by a register"),
        // b
        _ if op & 0xF800 == 0xE000 => Effect::Jump(relative(address, extend(op & 0x7FF, 11) << 1)),
        // bx lr
        0x4770 => Effect::None,
        // blx rm
        _ if op & 0xFF80 == 0x4780 => Effect::Indirect,
        // bx rm
        _ if op & 0xFF80 == 0x4700 => Effect::Indirect,
        _ => Effect::None,
    }
}

/// Instructions of 32 bits.
fn wide(first: u32, second: u32, address: u32) -> Effect {
    match first {
        // push.w {registers}
        0xE92D => Effect::Grow(4 * second.count_ones()),
        // str rt, [sp, #-imm]!
        0xF84D if second & 0x0F00 == 0x0D00 => Effect::Grow(second & 0xFF),
        // strd rt, rt2, [sp, #-imm]!
        0xE96D => Effect::Grow(4 * (second & 0xFF)),
        // vpush {registers}
        _ if first & 0xFFBF == 0xED2D => Effect::Grow(4 * (second & 0xFF)),
        // sub.w sp, sp, #imm
        _ if first & 0xFBEF == 0xF1AD && second & 0x8F00 == 0x0D00 => Effect::Grow(expand(first, second)),
        // subw sp, sp, #imm12
        _ if first & 0xFBFF == 0xF2AD && second & 0x8F00 == 0x0D00 => Effect::Grow(immediate(first, second)),
        // sub.w sp, sp, rm
        _ if first & 0xFFEF == 0xEBAD && second & 0x0F00 == 0x0D00 => Effect::Unknown("sp changed by a register"),
        // bl
        _ if first & 0xF800 == 0xF000 && second & 0xD000 == 0xD000 => Effect::Call(branch(first, second, address)),
        // b.w
        _ if first & 0xF800 == 0xF000 && second & 0xD000 == 0x9000 => Effect::Jump(branch(first, second, address)),
        // ldr pc, [...]
        _ if first & 0xFF70 == 0xF850 && second >> 12 == 15 => load_pc(first, second),
        _ => Effect::None,
    }
}

/// `ldr pc, [sp], #4` is a return; any other load of the program counter goes where the binary does not say.
fn load_pc(first: u32, second: u32) -> Effect {
    if first == 0xF85D && second == 0xFB04 { Effect::None } else { Effect::Indirect }
}

/// Target of `bl` and `b.w`: S, J1, J2, imm10 and imm11.
fn branch(first: u32, second: u32, address: u32) -> u32 {
    let sign = first >> 10 & 1;
    let i1 = !(second >> 13 ^ sign) & 1;
    let i2 = !(second >> 11 ^ sign) & 1;
    let offset = sign << 24 | i1 << 23 | i2 << 22 | (first & 0x3FF) << 12 | (second & 0x7FF) << 1;
    relative(address, extend(offset, 25))
}

/// The program counter reads four ahead.
fn relative(address: u32, offset: i32) -> u32 {
    address.wrapping_add(4).wrapping_add_signed(offset)
}

fn extend(value: u32, bits: u32) -> i32 {
    (value << (32 - bits)).cast_signed() >> (32 - bits)
}

/// i, imm3 and imm8 as twelve bits.
fn immediate(first: u32, second: u32) -> u32 {
    (first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xFF
}

/// `ThumbExpandImm`: a byte repeated, or a rotated one.
fn expand(first: u32, second: u32) -> u32 {
    let (coded, byte) = (immediate(first, second), second & 0xFF);
    match coded >> 8 {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte * 0x0101_0101,
        _ => (0x80 | coded & 0x7F).rotate_right(coded >> 7),
    }
}

#[cfg(test)]
mod tests {
    use super::{Effect, decode};

    fn effect(bytes: &[u8]) -> Effect {
        decode(bytes, 0x1000).expect("an instruction").effect
    }

    /// Encodings as `arm-none-eabi-as` gives them.
    #[test]
    fn cross_encodings_of_the_assembler_are_read() {
        assert_eq!(effect(&[0xF0, 0xB5]), Effect::Grow(20), "push {{r4-r7, lr}}");
        assert_eq!(effect(&[0x82, 0xB0]), Effect::Grow(8), "sub sp, #8");
        assert_eq!(effect(&[0x2D, 0xE9, 0xF0, 0x4F]), Effect::Grow(36), "push.w {{r4-r11, lr}}");
        assert_eq!(effect(&[0x2D, 0xED, 0x10, 0x8B]), Effect::Grow(64), "vpush {{d8-d15}}");
        assert_eq!(effect(&[0xAD, 0xF5, 0x00, 0x7D]), Effect::Grow(512), "sub.w sp, sp, #512");
        assert_eq!(effect(&[0xAD, 0xF2, 0x04, 0x4D]), Effect::Grow(1028), "subw sp, sp, #1028");
        assert_eq!(effect(&[0x4D, 0xF8, 0x04, 0x8D]), Effect::Grow(4), "str r8, [sp, #-4]!");
        assert_eq!(effect(&[0x00, 0xF0, 0x02, 0xF8]), Effect::Call(0x1008), "bl .+8");
        assert_eq!(effect(&[0xFF, 0xF7, 0xFE, 0xFF]), Effect::Call(0x1000), "bl .");
        assert_eq!(effect(&[0xFF, 0xF7, 0xFE, 0xBF]), Effect::Jump(0x1000), "b.w .");
        assert_eq!(effect(&[0xFE, 0xE7]), Effect::Jump(0x1000), "b .");
        assert_eq!(effect(&[0x98, 0x47]), Effect::Indirect, "blx r3");
        assert_eq!(effect(&[0x70, 0x47]), Effect::None, "bx lr");
        assert_eq!(effect(&[0x5D, 0xF8, 0x04, 0xFB]), Effect::None, "pop.w {{pc}}");
    }
}
