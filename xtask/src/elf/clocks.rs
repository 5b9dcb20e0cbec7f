//! Clocks of a Cortex-M0, by its instructions: Arm DDI 0432C, *Cortex-M0 Technical Reference Manual*, table 3-1, with the
//! multiplier of one clock that most makers chose (the nRF51's too) and memory without wait states.

/// Clocks of one instruction; `went_on` says that the one behind it came next.
pub(crate) fn cortex_m0(instruction: u16, went_on: bool) -> u32 {
    let listed = |mask: u16| (instruction & mask).count_ones();
    let to_pc = instruction & 0x0087 == 0x0087;
    match instruction {
        // ADD and MOV to the program counter
        0x4400..=0x44FF | 0x4600..=0x46FF if to_pc => 3,
        // LDR and STR, of any width and address
        0x4800..=0x9FFF => 2,
        // PUSH with or without LR, POP without PC, STM, LDM
        0xB400..=0xB5FF => 1 + listed(0x01FF),
        0xBC00..=0xBCFF | 0xC000..=0xCFFF => 1 + listed(0x00FF),
        // POP with PC
        0xBD00..=0xBDFF => 4 + listed(0x01FF),
        // B with a condition
        0xD000..=0xDDFF if went_on => 1,
        // BX, BLX; B
        0x4700..=0x47FF | 0xD000..=0xDDFF | 0xE000..=0xE7FF => 3,
        // BL, and what else has 32 bits
        0xE800..=0xFFFF => 4,
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::cortex_m0;

    /// Encodings as `arm-none-eabi-as` gives them.
    #[test]
    fn cross_clocks_are_those_of_the_manual() {
        for (instruction, clocks, name) in [
            (0x1840, 1, "adds r0, r0, r1"),
            (0x4348, 1, "muls r0, r1"),
            (0x6808, 2, "ldr r0, [r1]"),
            (0x9001, 2, "str r0, [sp, #4]"),
            (0x4A01, 2, "ldr r2, [pc, #4]"),
            (0xB5F0, 6, "push {r4-r7, lr}"),
            (0xBDF0, 9, "pop {r4-r7, pc}"),
            (0xBC30, 3, "pop {r4, r5}"),
            (0xC80E, 4, "ldm r0!, {r1-r3}"),
            (0xE7FE, 3, "b ."),
            (0xF000, 4, "bl"),
            (0x4770, 3, "bx lr"),
            (0x4687, 3, "mov pc, r0"),
            (0x4680, 1, "mov r8, r0"),
        ] {
            assert_eq!(cortex_m0(instruction, false), clocks, "{name}");
        }
        assert_eq!([cortex_m0(0xD0FE, false), cortex_m0(0xD0FE, true)], [3, 1], "beq .");
    }
}
