"""pysindy on the torque balance of the gimbal. Prints one line of JSON: sindy.py LOG MODEL STLSQ|SSR|FROLS

The motor torque has no column of its own: with one, everything times zero explains everything.

    r = Jg w' + H theta' + T_m - T_f - T_u = library * coefficients        w = (Bo theta' + Jo theta'') / H

Nonlinear functions first, then the same low-pass of 30 Hz over every column and r, one row in eight. The threshold (or the number of
terms) is the one with the least error on quarters of what is fitted that were left out in turn; then all of it is fitted again.
"""

import json
import sys
import warnings

import numpy as np
import pysindy as ps
from scipy.signal import butter, sosfiltfilt

from logs import G, Log, levels, nominal, rms

warnings.filterwarnings("ignore")
# nominal parameters: what of them is inside the tolerance is no effect; their coefficient is a relative change
TOLERANCE = {"friction_level": 0.15, "viscosity": 0.03, "mass_unbalance": 0.03, "gimbal_inertia": 0.03, "gyro": 0.03}


# columns of nominal parameters, the first
FIXED = 5
# ridge over the rows, for columns of rms 1
RIDGE = 1e-4
# numbers of terms that the greedy ones try
TERMS = [1, 2, 3, 4, 6, 9, 14]


def low_pass(values, hz):
    return sosfiltfilt(butter(4, hz, fs=1000, output="sos"), values)


def library(log, model):
    """The target and columns by the name of the effect that they stand for."""
    theta = low_pass(log.gyro_angle_rad, 60)
    slope = np.gradient(theta, 1e-3)
    w = (model["damping_nm_s_per_rad"] * slope + model["float_inertia_kg_m2"] * np.gradient(slope, 1e-3)) / model["angular_momentum_nm_s"]
    ax, ay, az, rate = log.accel_x_mps2, log.accel_y_mps2, log.accel_z_mps2, log.vehicle_rate_radps
    load, viscous = levels(model, ax, ay, az)
    rel_rate = rate - w
    rel = np.cumsum(rel_rate) * 1e-3
    clamp = np.clip(rel_rate / model["slip_rate_radps"], -1, 1)
    friction, unbalance = (load + viscous) * clamp, model["x_kg_m"] * ay
    momentum, inertia = model["angular_momentum_nm_s"] * slope, model["gimbal_inertia_kg_m2"] * np.gradient(w, 1e-3)
    target = inertia + momentum + log.motor_torque_nm - friction - unbalance
    columns = [
        ("friction_level", load * clamp), ("viscosity", viscous * clamp), ("mass_unbalance", unbalance),
        ("gimbal_inertia", -inertia), ("gyro", -momentum),
        ("viscous_friction", rel_rate), ("quadratic_drag", rel_rate * np.abs(rel_rate)), ("load_dependence", load * clamp * np.hypot(ax, ay) / G),
        ("direction_asymmetry", np.abs(friction)), ("mass_unbalance", -ax), ("anisoelasticity", ax * ay), ("cable_spring", rel),
        ("constant_torque", np.ones_like(ax)), ("cross_axis_coupling", rate * log.cross_rate_radps),
        ("time_skew", np.gradient(low_pass(friction + unbalance, 60), 1e-3)), ("cable_cubic", rel**3),
    ]  # fmt: skip
    columns += [("stribeck", clamp * np.exp(-((rel_rate / width) ** 2))) for width in (0.008, 0.025, 0.08, 0.25)]
    columns += [("friction_drift", -friction * np.expm1(-log.time_s / tau)) for tau in (5.0, 20.0, 60.0)]
    for n in range(3, 31):
        columns += [("torque_ripple", np.sin(n * rel)), ("torque_ripple", np.cos(n * rel))]
    thin = lambda values: low_pass(values, 30)[::8] if np.ptp(values) > 0 else values[::8]
    return thin(target), [name for name, _ in columns], np.stack([thin(values) for _, values in columns], axis=1)


def optimizers(kind, count, rows):
    if kind == "STLSQ":
        return [ps.STLSQ(threshold=t, alpha=RIDGE * rows, normalize_columns=False) for t in np.geomspace(3e-3, 3.0, 7)]
    if kind == "SSR":
        return [ps.SSR(alpha=RIDGE * rows, max_iter=count - terms) for terms in TERMS]
    return [ps.FROLS(alpha=RIDGE * rows, max_iter=terms) for terms in TERMS]


def fitted(optimizer, columns, target):
    model = ps.SINDy(optimizer=optimizer, feature_library=ps.IdentityLibrary())
    model.fit(columns[:, :1], t=8e-3, x_dot=target[:, None], u=columns[:, 1:])
    return model.coefficients()[0]


def main():
    log, model, kind = Log(sys.argv[1]), nominal(sys.argv[2]), sys.argv[3]
    target, names, columns = library(log, model)
    scale, size = np.sqrt(np.mean(columns**2, axis=0)), rms(target)
    scaled, unit = columns / scale, target / size
    begin, end = 1000 // 8, len(target) * 2 // 3
    blocks = np.array_split(np.arange(begin, end), 4)
    choices = optimizers(kind, len(names), end - begin)

    def error(optimizer):
        """On blocks that were left out, one after the other."""
        left = []
        for block in blocks:
            rest = np.setdiff1d(np.arange(begin, end), block)
            left.append(unit[block] - scaled[block] @ fitted(optimizer, scaled[rest], unit[rest]))
        return rms(np.concatenate(left))

    coefficients = fitted(min(choices, key=error), scaled[begin:end], unit[begin:end])
    after = size * rms(unit[end:] - scaled[end:] @ coefficients)
    strength = {}
    for place, (name, coefficient, own) in enumerate(zip(names, coefficients, scale)):
        # a nominal parameter inside its tolerance is no effect
        inside = abs(coefficient * size / own) <= TOLERANCE.get(name, 0.0) and place < FIXED
        if coefficient != 0 and not inside:
            strength[name] = np.hypot(strength.get(name, 0.0), coefficient)
    order = sorted(strength, key=strength.get, reverse=True)
    print(json.dumps({
        "found": order[0] if order else "none", "terms": int(np.count_nonzero(coefficients)), "others": order[1:5],
        "before": rms(target[end:]), "after": after,
    }))  # fmt: skip


main()
