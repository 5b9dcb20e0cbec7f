"""scipy.optimize.least_squares on the simulated loop; the effect is told. Prints one line of JSON: fit.py LOG MODEL EFFECT"""

import json
import sys
import time

import numpy as np
from scipy.optimize import least_squares

import loop
from logs import SIGMA, Log, levels, nominal, rms

NOMINAL = ["Jg", "K", "T", "T1", "T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9", "Jo", "Bo", "H", "load", "viscous", "slip", "ux"]
# what is fitted for each effect: parameters, where they start, their scale
EFFECTS = {
    "none": ([], [], []),
    "stribeck": (["excess", "width"], [2e-4, 0.05], [1e-4, 0.02]),
    "quadratic_drag": (["drag"], [1e-4], [1e-4]),
    "cable_spring": (["spring"], [1e-4], [1e-4]),
    "torque_ripple": (["ripple", "cycles", "phase"], [5e-5, 12.0, 0.0], [1e-4, 0.1, 0.3]),
    "mass_unbalance": (["change_x", "change_y"], [0.0, 0.0], [1e-5, 1e-5]),
    "loop_delay": (["delay"], [5e-5], [1e-4]),
    "gyro_damping": (["damping"], [0.0], [0.1]),
    "time_skew": (["skew"], [2e-4], [1e-3]),
}


class Fit:
    def __init__(self, log, model, effect):
        self.log, self.model, self.effect = log, model, effect
        self.names, self.start, self.scales = EFFECTS[effect]
        self.calls = 0

    def simulate(self, values, rows):
        """theta and torque of the first rows."""
        self.calls += 1
        log, model = self.log, self.model
        change = dict(zip(NOMINAL, 0.03 * values[: len(NOMINAL)]))
        change["load"] *= 5  # 15 %
        scaled = dict(zip(self.names, values[len(NOMINAL) :] * self.scales))
        of = lambda key, name: model[key] * (1 + change[name])
        leads = [value * (1 + change[f"T{i + 1}"]) for i, value in enumerate(model["lead_time_constants_s"])]
        lags = [value * (1 + change[f"T{i + 6}"]) for i, value in enumerate(model["lag_time_constants_s"])]
        p = {
            "Jg": of("gimbal_inertia_kg_m2", "Jg"), "K": of("gain_nm_per_rad_s", "K"), "T": of("motor_lag_s", "T"),
            "Jo": of("float_inertia_kg_m2", "Jo"), "H": of("angular_momentum_nm_s", "H"), "leads": leads, "lags": lags,
            "Bo": of("damping_nm_s_per_rad", "Bo") * (1 + scaled.get("damping", 0)), "delay": abs(scaled.get("delay", 0.0)),
        }
        t = log.time_s[:rows] + scaled.get("skew", 0.0)
        at = lambda name: np.interp(t, log.time_s, getattr(log, name)) if "skew" in scaled else getattr(log, name)[:rows]
        ax, ay, az, rate = (at(name) for name in ("accel_x_mps2", "accel_y_mps2", "accel_z_mps2", "vehicle_rate_radps"))
        load, viscous = levels(model, ax, ay, az)
        ux = of("x_kg_m", "ux") + scaled.get("change_x", 0.0)
        other = ux * ay - (model["y_kg_m"] + scaled.get("change_y", 0.0)) * ax
        a, start, end = loop.matrices(p)
        get = lambda name, default=0.0: float(scaled.get(name, default))
        return loop.run(
            a, start, end, np.ascontiguousarray(rate), load * (1 + change["load"]), viscous * (1 + change["viscous"]), other,
            of("slip_rate_radps", "slip"), p["delay"], get("excess"), max(abs(get("width", 1.0)), 1e-3), get("drag"), get("spring"),
            get("ripple"), get("cycles"), get("phase"),
        )  # fmt: skip

    def residual(self, values):
        fitted = self.log.fitted
        theta, torque = self.simulate(values, fitted.stop)
        parts = [
            (self.log.gyro_angle_rad[fitted] - theta[fitted]) / SIGMA["gyro_angle_rad"],
            (self.log.motor_torque_nm[fitted] - torque[fitted]) / SIGMA["motor_torque_nm"],
            np.sqrt(3.0) * values[: len(NOMINAL)],  # uniform inside the tolerance
        ]
        return np.nan_to_num(np.concatenate(parts), nan=1e6, posinf=1e6, neginf=-1e6)

    def first(self):
        """Nominal parameters, the effect where a user would start it; ripple at the best of 60 lines of the torque's residual."""
        values = np.concatenate([np.zeros(len(NOMINAL)), np.array(self.start) / np.array(self.scales or [1.0])[: len(self.start)]])
        if self.effect == "torque_ripple":
            values[len(NOMINAL)] = 0.0
            _, torque = self.simulate(values, self.log.fitted.stop)
            left = (self.log.motor_torque_nm[: len(torque)] - torque)[1000:]
            angle = np.cumsum(self.log.vehicle_rate_radps)[1000 : len(torque)] * 1e-3
            lines = [(abs(np.vdot(np.exp(1j * n * angle), left)), n, np.vdot(np.exp(1j * n * angle), left)) for n in range(1, 61)]
            power, n, line = max(lines, key=lambda one: one[0])
            values[len(NOMINAL) :] = np.array([2 * power / len(left), n, np.angle(1j * line)]) / self.scales
        return values


def main():
    log, model, effect = Log(sys.argv[1]), nominal(sys.argv[2]), sys.argv[3]
    fit = Fit(log, model, effect)
    fit.simulate(fit.first(), 10)
    start = time.perf_counter()
    first = fit.first()
    found = least_squares(fit.residual, first, method="trf", x_scale="jac", diff_step=1e-3, max_nfev=25)
    theta, torque = fit.simulate(found.x, log.rows)
    seconds = time.perf_counter() - start
    before, _ = fit.simulate(np.zeros_like(first), log.rows)
    values = dict(zip(fit.names, (found.x[len(NOMINAL) :] * fit.scales).tolist()))
    held = log.held_out
    print(json.dumps({
        "seconds_inside": seconds, "simulations": fit.calls, "status": int(found.status), "values": values, "found": "told",
        "before": rms((log.gyro_angle_rad - before)[held]), "after": rms((log.gyro_angle_rad - theta)[held]),
        "after_torque": rms((log.motor_torque_nm - torque)[held]),
    }))  # fmt: skip


main()
