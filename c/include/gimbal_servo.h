#ifndef GIMBAL_SERVO_H
#define GIMBAL_SERVO_H

/* Written by `cargo xtask header` from c/src; `cargo xtask test` compares it. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GIMBAL_ALIGNED(n) __attribute__((aligned(n)))

// Bytes that hold a law.
#define GIMBAL_LAW_BYTES 6144

// Bytes that hold a state.
#define GIMBAL_STATE_BYTES 512

// One gimbal axis, in SI: the fields of the model file, each after the name of its table.
typedef struct GimbalConfig {
  // Jg, inertia of the stable member about the gimbal axis [kg m2].
  double servo_gimbal_inertia_kg_m2;
  // K, gain of F(s) [N m/(rad s)].
  double servo_gain_nm_per_rad_s;
  // T1 to T5, the zeros of F(s) [s].
  double servo_lead_time_constants_s[5];
  // T6 to T9, the poles of F(s) [s].
  double servo_lag_time_constants_s[4];
  // T, the motor's first-order lag [s].
  double servo_motor_lag_s;
  // Jo [kg m2].
  double gyro_float_inertia_kg_m2;
  // Bo [N m s/rad].
  double gyro_damping_nm_s_per_rad;
  // H [N m s].
  double gyro_angular_momentum_nm_s;
  // Angle of the stops [rad].
  double gyro_stop_angle_rad;
  // Whether the spin-axis rate acts on the gyro.
  bool gyro_cross_coupling;
  // Number of bearings; 0: no friction.
  uint32_t bearing_count;
  // Axial preload of each [N].
  double bearing_preload_n;
  // Weight that they carry [N].
  double bearing_gimbal_weight_n;
  // dm [m].
  double bearing_pitch_diameter_m;
  // c of (6.1) [N m/N].
  double bearing_load_torque_nm_per_n;
  // Exponent of `F_s`.
  double bearing_load_exponent;
  // Factor of `F_a` in `F_s`.
  double bearing_static_axial_factor;
  // Factor of `F_r` in `F_s`.
  double bearing_static_radial_factor;
  // Factor of `F_a` in (6.1).
  double bearing_torque_axial_factor;
  // Factor of `F_r` in (6.1).
  double bearing_torque_radial_factor;
  // f0.
  double bearing_lubrication_factor;
  // nu [m2/s].
  double bearing_viscosity_m2ps;
  // Viscous law: Harris's metric pair; false: the pair that the paper implies.
  bool bearing_viscous_metric;
  // `w_s` [rad/s].
  double bearing_slip_rate_radps;
  // -m `r_x` [kg m].
  double unbalance_x_kg_m;
  // -m `r_y` [kg m].
  double unbalance_y_kg_m;
  // Largest specific force along x and y [m/s2].
  double range_radial_accel_mps2;
  // Largest specific force along z [m/s2].
  double range_axial_accel_mps2;
  // Largest vehicle rate [rad/s].
  double range_rate_radps;
  // Largest external torque [N m].
  double range_torque_nm;
  // Time between two steps [s].
  double period_s;
  // Whether a row of inputs is held until the next; false: the mean of both acts.
  bool inputs_held;
} GimbalConfig;

// A law: built once, never changed.
typedef struct GIMBAL_ALIGNED(16) GimbalLawFixed {
  uint8_t storage[GIMBAL_LAW_BYTES];
} GimbalLawFixed;

// A state: plain memory, which may be copied.
typedef struct GIMBAL_ALIGNED(16) GimbalStateFixed {
  uint8_t storage[GIMBAL_STATE_BYTES];
} GimbalStateFixed;

// One row of input as 32-bit fractions, 2^31 of their full scales.
typedef struct GimbalInputFixed {
  // Specific force along x [m/s2].
  int32_t accel_x_mps2;
  // Specific force along y [m/s2].
  int32_t accel_y_mps2;
  // Specific force along the gimbal axis z [m/s2].
  int32_t accel_z_mps2;
  // Vehicle rate about the gimbal axis [rad/s].
  int32_t vehicle_rate_radps;
  // External torque on the gimbal, beside friction and unbalance [N m].
  int32_t torque_nm;
  // The stable member's rate about the gyro's spin axis [rad/s].
  int32_t spin_rate_radps;
} GimbalInputFixed;

// The axis at the instant of the row just given, as 32-bit fractions, 2^31 of their full scales.
typedef struct GimbalOutputFixed {
  // phi, the attitude error [rad].
  int32_t gimbal_angle_rad;
  // phi' [rad/s].
  int32_t gimbal_rate_radps;
  // theta [rad].
  int32_t gyro_angle_rad;
  // `T_m` [N m].
  int32_t motor_torque_nm;
  // Friction torque on the gimbal [N m].
  int32_t friction_torque_nm;
  // Torque of the mass unbalance [N m].
  int32_t unbalance_torque_nm;
  // Mean of all disturbance torques over the period just past [N m].
  int32_t disturbance_torque_nm;
  // Vehicle rate less phi' [rad/s].
  int32_t relative_rate_radps;
  // How many periods ago the float met or left a stop; 0: it did not.
  int32_t stop_change_age;
  // The gyro's float: 0 free, 1 on the positive stop, -1 on the negative one.
  int8_t stop;
  // Fault bits: 1 gyro saturated, 2 offset left, 4 input out of range, 8 input not finite, 16 table end,
  // 32 arithmetic saturated, 64 small angle exceeded.
  uint16_t faults;
} GimbalOutputFixed;

// One row of input in SI.
typedef struct GimbalInputF32 {
  // Specific force along x [m/s2].
  float accel_x_mps2;
  // Specific force along y [m/s2].
  float accel_y_mps2;
  // Specific force along the gimbal axis z [m/s2].
  float accel_z_mps2;
  // Vehicle rate about the gimbal axis [rad/s].
  float vehicle_rate_radps;
  // External torque on the gimbal, beside friction and unbalance [N m].
  float torque_nm;
  // The stable member's rate about the gyro's spin axis [rad/s].
  float spin_rate_radps;
} GimbalInputF32;

// The axis at the instant of the row just given, in SI.
typedef struct GimbalOutputF32 {
  // phi, the attitude error [rad].
  float gimbal_angle_rad;
  // phi' [rad/s].
  float gimbal_rate_radps;
  // theta [rad].
  float gyro_angle_rad;
  // `T_m` [N m].
  float motor_torque_nm;
  // Friction torque on the gimbal [N m].
  float friction_torque_nm;
  // Torque of the mass unbalance [N m].
  float unbalance_torque_nm;
  // Mean of all disturbance torques over the period just past [N m].
  float disturbance_torque_nm;
  // Vehicle rate less phi' [rad/s].
  float relative_rate_radps;
  // How many periods ago the float met or left a stop; 0: it did not.
  float stop_change_age;
  // The gyro's float: 0 free, 1 on the positive stop, -1 on the negative one.
  int8_t stop;
  // Fault bits: 1 gyro saturated, 2 offset left, 4 input out of range, 8 input not finite, 16 table end,
  // 32 arithmetic saturated, 64 small angle exceeded.
  uint16_t faults;
} GimbalOutputF32;

// A law: built once, never changed.
typedef struct GIMBAL_ALIGNED(16) GimbalLawF32 {
  uint8_t storage[GIMBAL_LAW_BYTES];
} GimbalLawF32;

// A state: plain memory, which may be copied.
typedef struct GIMBAL_ALIGNED(16) GimbalStateF32 {
  uint8_t storage[GIMBAL_STATE_BYTES];
} GimbalStateF32;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The paper's parameters, the misprints among them put right.
void gimbal_config_consistent(struct GimbalConfig *config);

// The paper's parameters as they are printed.
void gimbal_config_as_printed(struct GimbalConfig *config);

// Builds a law, once: in double precision, with some kilobytes of stack. False: it cannot be built, and `message`
// says why, in at most `message_bytes` with the closing zero.
//
// # Safety
// `message` must be writable for `message_bytes`; it may be null when that is 0.
bool gimbal_fixed_build(const struct GimbalConfig *config,
                        struct GimbalLawFixed *law,
                        char *message,
                        uintptr_t message_bytes);

// The state at rest, before the first row.
void gimbal_fixed_start(const struct GimbalLawFixed *law, struct GimbalStateFixed *state);

// Takes the row of this instant and gives the axis at it. Once each period; bounded in time, no allocation, no lock.
void gimbal_fixed_step(const struct GimbalLawFixed *law,
                       struct GimbalStateFixed *state,
                       const struct GimbalInputFixed *input,
                       struct GimbalOutputFixed *output);

// Velocity error so far, along x and y [m/s].
void gimbal_fixed_velocity_error_mps(const struct GimbalLawFixed *law,
                                     const struct GimbalStateFixed *state,
                                     double (*velocity_error_mps)[2]);

// Position error so far, along x and y [m].
void gimbal_fixed_position_error_m(const struct GimbalLawFixed *law,
                                   const struct GimbalStateFixed *state,
                                   double (*position_error_m)[2]);

// A row in SI as this law's fractions.
void gimbal_fixed_input(const struct GimbalLawFixed *law,
                        const struct GimbalInputF32 *si,
                        struct GimbalInputFixed *input);

// This law's output in SI.
void gimbal_fixed_output(const struct GimbalLawFixed *law,
                         const struct GimbalOutputFixed *output,
                         struct GimbalOutputF32 *si);

// Builds a law, once: in double precision, with some kilobytes of stack. False: it cannot be built, and `message`
// says why, in at most `message_bytes` with the closing zero.
//
// # Safety
// `message` must be writable for `message_bytes`; it may be null when that is 0.
bool gimbal_f32_build(const struct GimbalConfig *config,
                      struct GimbalLawF32 *law,
                      char *message,
                      uintptr_t message_bytes);

// The state at rest, before the first row.
void gimbal_f32_start(const struct GimbalLawF32 *law, struct GimbalStateF32 *state);

// Takes the row of this instant and gives the axis at it. Once each period; bounded in time, no allocation, no lock.
void gimbal_f32_step(const struct GimbalLawF32 *law,
                     struct GimbalStateF32 *state,
                     const struct GimbalInputF32 *input,
                     struct GimbalOutputF32 *output);

// Velocity error so far, along x and y [m/s].
void gimbal_f32_velocity_error_mps(const struct GimbalLawF32 *law,
                                   const struct GimbalStateF32 *state,
                                   double (*velocity_error_mps)[2]);

// Position error so far, along x and y [m].
void gimbal_f32_position_error_m(const struct GimbalLawF32 *law,
                                 const struct GimbalStateF32 *state,
                                 double (*position_error_m)[2]);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* GIMBAL_SERVO_H */
