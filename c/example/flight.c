/* The 1 kHz call in C: the step in the timer's interrupt, its output to the main loop by a queue of one producer and one
 * consumer, in single precision and in fixed point side by side. Ten seconds of flight on an emulated Cortex-M4F; the
 * digests of all outputs are those of the Rust library on the host. Built and run by `cargo xtask test --only c-interface`. */
#include "gimbal_servo.h"
#include "flight_rows.h"
#include "semihosting.h"

#define STEPS 10000u
#define PERIOD_CYCLES 25000u /* 1 ms at 25 MHz */
#define QUEUE 8u

static struct GimbalConfig config;
static struct GimbalLawF32 law;
static struct GimbalStateF32 state;
static struct GimbalOutputF32 queue[QUEUE];
static struct GimbalLawFixed fixed_law;
static struct GimbalStateFixed fixed_state;
static struct GimbalOutputFixed fixed_queue[QUEUE];
static volatile uint32_t written, taken;

/* Row k of the flight: 100 rows a second, interpolated linearly. Your sensors' reading goes here. */
static struct GimbalInputF32 row(uint32_t k)
{
    const double degree = 3.14159265358979311600 / 180.0;
    double part = (double)(k % 10u) * 0.1;
    double value[4];
    for (int i = 0; i < 4; i++) {
        double now = flight_rows[k / 10u][i], next = flight_rows[k / 10u + 1u][i];
        value[i] = now + (next - now) * part;
    }
    struct GimbalInputF32 input = {0};
    input.accel_x_mps2 = (float)(value[0] * 0.01);
    input.accel_y_mps2 = (float)(value[1] * 0.01);
    input.accel_z_mps2 = (float)(value[2] * 0.01);
    input.vehicle_rate_radps = (float)(value[3] * (0.01 * degree));
    return input;
}

void SysTick_Handler(void)
{
    if (written < STEPS && written - taken < QUEUE) {
        struct GimbalInputF32 input = row(written);
        gimbal_f32_step(&law, &state, &input, &queue[written % QUEUE]);
        struct GimbalInputFixed fractions;
        gimbal_fixed_input(&fixed_law, &input, &fractions);
        gimbal_fixed_step(&fixed_law, &fixed_state, &fractions, &fixed_queue[written % QUEUE]);
        written = written + 1u;
    }
}

#define FNV_BASIS 0xCBF29CE484222325u /* FNV-1a */
static uint64_t digest = FNV_BASIS, fixed_digest = FNV_BASIS;

static void add(uint64_t *sum, const void *bytes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        *sum = (*sum ^ ((const uint8_t *)bytes)[i]) * 0x100000001B3u;
}

/* Both outputs begin with nine signals of four bytes. */
static void add_output(uint64_t *sum, const void *signals, int8_t stop, uint16_t faults)
{
    uint8_t code = stop < 0 ? 2u : (uint8_t)stop;
    add(sum, signals, 9u * 4u);
    add(sum, &code, 1);
    add(sum, &faults, 2);
}

static void report(const char *name, uint64_t sum)
{
    print("tick ");
    print(name);
    print(" 10000 steps ");
    print_hex(sum);
    print("\n");
}

int main(void)
{
    char message[160];
    gimbal_config_consistent(&config);

    /* A configuration that is wrong is refused, and the message says what is. */
    config.servo_motor_lag_s = -1.0;
    if (gimbal_f32_build(&config, &law, message, sizeof message))
        return 1;
    print(message);
    print("\n");

    gimbal_config_consistent(&config);
    if (!gimbal_f32_build(&config, &law, message, sizeof message)
        || !gimbal_fixed_build(&config, &fixed_law, message, sizeof message)) {
        print(message);
        return 1;
    }
    gimbal_f32_start(&law, &state);
    gimbal_fixed_start(&fixed_law, &fixed_state);
    volatile uint32_t *systick = (volatile uint32_t *)0xE000E010u;
    systick[1] = PERIOD_CYCLES - 1u;
    systick[2] = 0u;
    systick[0] = 7u; /* core clock, interrupt, on */
    while (taken < STEPS) {
        if (taken != written) {
            const struct GimbalOutputF32 *output = &queue[taken % QUEUE];
            const struct GimbalOutputFixed *fixed = &fixed_queue[taken % QUEUE];
            add_output(&digest, output, output->stop, output->faults);
            add_output(&fixed_digest, fixed, fixed->stop, fixed->faults);
            taken = taken + 1u;
        } else {
            __asm volatile("wfi");
        }
    }
    report("f32", digest);
    report("fixed", fixed_digest);
    return 0;
}
