//! As much of RV32IMAC as shows where code goes and how far the stack grows
//! (The RISC-V Instruction Set Manual, volume I, chapters 2, 16 and 24).

use super::code::{Effect, Step};

const RA: u32 = 1;
const SP: u32 = 2;

/// The instruction at `address`, whose bytes come first in `code`.
pub(super) fn decode(code: &[u8], address: u32) -> Option<Step> {
    let half = |at: usize| Some(u32::from(u16::from_le_bytes(code.get(at..at + 2)?.try_into().ok()?)));
    let first = half(0)?;
    if first & 3 != 3 {
        return Some(Step { bytes: 2, effect: compressed(first, address) });
    }
    let op = first | half(2)? << 16;
    // A far call is two instructions: auipc, and jalr by the same register.
    if op & 0x7F == 0x17
        && let (Some(low), Some(high)) = (half(4), half(6))
        && let Some(effect) = far(op, low | high << 16, address)
    {
        return Some(Step { bytes: 8, effect });
    }
    Some(Step { bytes: 4, effect: full(op, address) })
}

/// Instructions of 32 bits.
fn full(op: u32, address: u32) -> Effect {
    let (rd, rs1, kind) = (op >> 7 & 31, op >> 15 & 31, op >> 12 & 7);
    match op & 0x7F {
        // addi sp, sp, imm
        0x13 if kind == 0 && rd == SP && rs1 == SP => grow(op.cast_signed() >> 20),
        // add sp, sp, rs2 and sub
        0x33 if rd == SP => Effect::Unknown("sp changed by a register"),
        // jal
        0x6F => {
            let offset = op >> 31 << 20 | (op >> 12 & 0xFF) << 12 | (op >> 20 & 1) << 11 | (op >> 21 & 0x3FF) << 1;
            let target = address.wrapping_add_signed(extend(offset, 21));
            if rd == 0 { Effect::Jump(target) } else { Effect::Call(target) }
        }
        // jalr: a return, or somewhere that the binary does not say
        0x67 if rd == 0 && rs1 == RA => Effect::None,
        0x67 => Effect::Indirect,
        _ => Effect::None,
    }
}

/// Instructions of 16 bits.
fn compressed(op: u32, address: u32) -> Effect {
    let (rd, rs2) = (op >> 7 & 31, op >> 2 & 31);
    match (op >> 13, op & 3) {
        // c.addi sp, imm
        (0, 1) if rd == SP => grow(extend(op >> 12 << 5 & 32 | rs2, 6)),
        // c.addi16sp
        (3, 1) if rd == SP => {
            let bit = |from: u32, to: u32| (op >> from & 1) << to;
            grow(extend(bit(12, 9) | bit(6, 4) | bit(5, 6) | bit(4, 8) | bit(3, 7) | bit(2, 5), 10))
        }
        // c.jal, c.j
        (1, 1) => Effect::Call(address.wrapping_add_signed(near(op))),
        (5, 1) => Effect::Jump(address.wrapping_add_signed(near(op))),
        // c.jr ra; c.jr, c.jalr with another register
        (4, 2) if rs2 == 0 && op >> 12 & 1 == 0 && rd == RA => Effect::None,
        (4, 2) if rs2 == 0 && rd != 0 => Effect::Indirect,
        // c.mv sp and c.add sp
        (4, 2) if rd == SP => Effect::Unknown("sp changed by a register"),
        _ => Effect::None,
    }
}

/// Offset of c.j and c.jal.
fn near(op: u32) -> i32 {
    let bit = |from: u32, to: u32| (op >> from & 1) << to;
    let low = bit(3, 1) | bit(4, 2) | bit(5, 3) | bit(11, 4) | bit(2, 5);
    extend(low | bit(7, 6) | bit(6, 7) | bit(9, 8) | bit(10, 9) | bit(8, 10) | bit(12, 11), 12)
}

/// `auipc r, high` with `jalr rd, low(r)`.
fn far(high: u32, low: u32, address: u32) -> Option<Effect> {
    let (register, link) = (high >> 7 & 31, low >> 7 & 31);
    if low & 0x7F != 0x67 || low >> 15 & 31 != register {
        return None;
    }
    let target = address.wrapping_add(high & 0xFFFF_F000).wrapping_add_signed(low.cast_signed() >> 20);
    Some(if link == 0 { Effect::Jump(target) } else { Effect::Call(target) })
}

fn grow(change: i32) -> Effect {
    if change < 0 { Effect::Grow(change.unsigned_abs()) } else { Effect::None }
}

fn extend(value: u32, bits: u32) -> i32 {
    (value << (32 - bits)).cast_signed() >> (32 - bits)
}

#[cfg(test)]
mod tests {
    use super::{Effect, decode};

    fn effect(bytes: &[u8]) -> Effect {
        decode(bytes, 0x1000).expect("an instruction").effect
    }

    /// Encodings as the assembler of LLVM gives them.
    #[test]
    fn cross_encodings_of_the_assembler_are_read() {
        assert_eq!(effect(&[0x41, 0x11]), Effect::Grow(16), "addi sp, sp, -16");
        assert_eq!(effect(&[0x39, 0x71]), Effect::Grow(64), "addi sp, sp, -64");
        assert_eq!(effect(&[0x21, 0x61]), Effect::None, "addi sp, sp, 64");
        assert_eq!(effect(&[0x13, 0x01, 0x01, 0xC0]), Effect::Grow(1024), "addi sp, sp, -1024");
        assert_eq!(effect(&[0x21, 0x20]), Effect::Call(0x1008), "jal .+8");
        assert_eq!(effect(&[0x21, 0xA0]), Effect::Jump(0x1008), "j .+8");
        assert_eq!(effect(&[0xEF, 0x00, 0x80, 0x00]), Effect::Call(0x1008), "jal ra, .+8");
        assert_eq!(effect(&[0x97, 0x10, 0, 0, 0xE7, 0x80, 0x80, 0]), Effect::Call(0x2008), "call .+4104");
        assert_eq!(effect(&[0x82, 0x80]), Effect::None, "ret");
        assert_eq!(effect(&[0x82, 0x97]), Effect::Indirect, "jalr a5");
    }
}
