"""The closed loop at 4 kHz, compiled: linear part exact for inputs that run along lines, friction implicit in its clamp.

    Jg w' = T_d - H theta' - T_m(t - d)        Jo theta'' = H w - Bo theta'        T_m = F(s) / (1 + T s) theta
"""

import numba
import numpy as np
from scipy.linalg import expm

STEPS = 4
RATE, THETA, SLOPE, SECTION, INTEGRAL, TORQUE, DELAYED, DELAYED_RATE = 0, 1, 2, 3, 7, 8, 9, 10


def matrices(p):
    """One step of 0.25 ms: state, torque at its start, torque at its end."""
    a, order = np.zeros((11, 11)), 11
    a[RATE, SLOPE] = -p["H"] / p["Jg"]
    a[THETA, SLOPE] = 1
    a[SLOPE, RATE], a[SLOPE, SLOPE] = p["H"] / p["Jo"], -p["Bo"] / p["Jo"]
    signal = np.zeros(order)
    signal[THETA] = p["K"]
    for index, (lead, lag) in enumerate(zip(p["leads"], p["lags"])):
        own = np.zeros(order)
        own[SECTION + index] = 1
        drive = signal - own
        a[SECTION + index] = drive / lag
        signal = own + lead / lag * drive
    a[INTEGRAL] = signal
    command = p["leads"][4] * signal
    command[INTEGRAL] += 1
    command[TORQUE] -= 1
    a[TORQUE] = command / p["T"]
    d = max(p["delay"], 1e-5)
    a[DELAYED, DELAYED_RATE] = 1
    a[DELAYED_RATE, TORQUE], a[DELAYED_RATE, DELAYED], a[DELAYED_RATE, DELAYED_RATE] = 12 / d**2, -12 / d**2, -6 / d
    a[RATE, TORQUE] -= 1 / p["Jg"]
    shift = p["delay"]  # Pade of order 2: T_m(t - d) = T_m - d v'
    a[RATE, DELAYED_RATE] += shift / p["Jg"]
    h = 1e-3 / STEPS
    wide = np.zeros((order + 2, order + 2))
    wide[:order, :order] = a * h
    wide[RATE, order] = h / p["Jg"]
    wide[order, order + 1] = 1
    whole = expm(wide)
    end = whole[:order, order + 1]
    return whole[:order, :order].copy(), whole[:order, order] - end, end.copy()


@numba.njit(cache=True, fastmath=True)
def run(a, start, end, rate, load, viscous, other, slip, delay, excess, width, drag, spring, ripple, cycles, phase):
    """theta and motor torque, row after row, from where the servo carries the first row."""
    rows = rate.shape[0]
    theta, motor = np.empty(rows), np.empty(rows)
    x, y = np.zeros(11), np.zeros(11)
    relative = 0.0
    level = load[0] + viscous + excess * np.exp(-((rate[0] / width) ** 2))
    torque = level * min(1.0, max(-1.0, rate[0] / slip)) + other[0] + ripple * np.sin(phase) + drag * rate[0] * abs(rate[0])
    x[7], x[8], x[9] = torque, torque, torque
    theta[0], motor[0] = 0.0, torque
    h = 1e-3 / 4
    for k in range(1, rows):
        for step in range(1, 5):
            s = 0.25 * step
            r = rate[k - 1] + s * (rate[k] - rate[k - 1])
            relative += h * (r - x[0])
            w = r - x[0]
            level = load[k - 1] + s * (load[k] - load[k - 1]) + viscous + excess * np.exp(-((w / width) ** 2))
            rest = other[k - 1] + s * (other[k] - other[k - 1]) + drag * w * abs(w) + spring * relative
            if ripple != 0.0:
                rest += ripple * np.sin(cycles * relative + phase)
            for i in range(11):
                total = start[i] * torque + end[i] * rest
                for j in range(11):
                    total += a[i, j] * x[j]
                y[i] = total
            friction = level * (r - y[0]) / (slip + level * end[0])
            friction = min(level, max(-level, friction))
            for i in range(11):
                x[i] = y[i] + end[i] * friction
            torque = rest + friction
        theta[k] = x[1]
        motor[k] = x[8] - delay * x[10]
    return theta, motor
