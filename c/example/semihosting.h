/* Text and exit status by semihosting (Arm, "Semihosting for AArch32 and AArch64", 2.0). */
#ifndef SEMIHOSTING_H
#define SEMIHOSTING_H

#include <stdint.h>

static inline uintptr_t semihosting(uintptr_t operation, const volatile void *argument)
{
    register uintptr_t r0 __asm("r0") = operation;
    register uintptr_t r1 __asm("r1") = (uintptr_t)argument;
    __asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

/* SYS_WRITE0 writes to the debugger's console. */
static inline void print(const char *text)
{
    semihosting(0x04, text);
}

static inline void print_hex(uint64_t value)
{
    char text[17];
    for (int i = 0; i < 16; i++)
        text[i] = "0123456789abcdef"[(value >> (60 - 4 * i)) & 15u];
    text[16] = 0;
    print(text);
}

/* SYS_EXIT_EXTENDED: the application has ended, with this status. */
static inline void leave(int status)
{
    volatile uintptr_t block[2] = {0x20026, (uintptr_t)status};
    semihosting(0x20, block);
}

#endif
