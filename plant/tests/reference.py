"""Solves two scenarios with SciPy's Radau and writes reference.csv: python3 reference.py > reference.csv

The servo is in partial fractions, friction is a plain clip, and every row is a new initial-value problem.
"""
import numpy as np
from scipy.integrate import solve_ivp

JG, JO, BO, H, K = 3.2964e-3, 3.40e-5, 9.27e-3, 4.00e-2, 8.3448323
LEADS = [2.16, 0.0385, 0.0156, 0.0127, 0.168]
LAGS = [2.24, 0.00306, 0.00168, 0.00131, 0.001]
STOP, G, T, SLIP = np.radians(0.5), 9.80665, 1e-3, 2e-3
POUND, INCH = 4.4482216152605, 0.0254
UNBALANCE = 9.8e-4 / G

# F(s)/(1+Ts) = r0/s + sum r_i/(s + p_i)
POLES = 1 / np.array(LAGS)
numerator = lambda s: K * np.prod([1 + t * s for t in LEADS])
R0 = K
R = [numerator(-p) / -p / np.prod([1 - t * p for t in LAGS if t != LAGS[i]]) * p for i, p in enumerate(POLES)]


def friction(a, w):
    fa = 5 + 5.49 / 4 * abs(a[2]) / G
    fr = 5.49 / 4 * np.hypot(a[0], a[1]) / G
    load = 2.77 * fa - 0.1 * fr if fr <= 2.77 / 1.1 * fa else fr
    level = 1.604e-4 * (0.42 * fa + 0.5 * fr) ** 0.33 * load
    speed = 13.7 * abs(w) * 30 / np.pi
    level += 0.974**3 * (3.492e-3 if speed <= 2000 else 1.42e-5 * speed ** (2 / 3))
    return 4 * level * POUND * INCH * np.clip(w / SLIP, -1, 1)


def slope(y, a, rate, torque, stop, with_friction):
    phi, phi1, theta, theta1 = y[:4]
    motor = y[4:10].sum()
    td = torque + (UNBALANCE * a[1] + friction(a, rate - phi1) if with_friction else 0)
    d = np.empty(14)
    d[0], d[1] = phi1, (td - H * theta1 - motor) / JG
    d[2], d[3] = (theta1, (H * phi1 - BO * theta1) / JO) if stop == 0 else (0, 0)
    d[4] = R0 * theta
    d[5:10] = np.array(R) * theta - POLES * y[5:10]
    d[10], d[11] = a[1] * phi, -a[0] * phi
    d[12], d[13] = y[10], y[11]
    return d


def advance(y, stop, inputs, with_friction, t1):
    t = 0.0
    while t < t1:
        f = lambda t, y: slope(y, *inputs(t), stop, with_friction)
        hit = (lambda t, y: STOP - abs(y[2])) if stop == 0 else (lambda t, y: stop * y[1] + 1e-18)
        hit.terminal, hit.direction = True, -1
        s = solve_ivp(f, (t, t1), y, "Radau", rtol=3e-13, atol=1e-14, events=hit, first_step=(t1 - t) / 50)
        t, y = s.t[-1], s.y[:, -1].copy()
        if s.status == 1:
            if stop == 0:
                stop = np.sign(y[2])
                y[2], y[3] = stop * STOP, 0
            else:
                stop = 0
    return y, stop


def flight(t):
    a = np.array([60 * np.sin(5 * t), 130 * np.sin(7 * t + 0.3), 20 * np.cos(11 * t)])
    return a, 17 * np.sin(13 * t + 0.1), 0.0


def run(name, row, count, every, with_friction):
    y, stop = np.zeros(14), 0
    for k in range(count + 1):
        if k % every == 0:
            print(",".join([name, str(k)] + ["%.15e" % v for v in (y[0], y[2], y[4:10].sum(), *y[10:14])]))
        a0, w0, t0 = row(k * T)
        a1, w1, t1 = row((k + 1) * T)
        lerp = lambda t: (a0 + (a1 - a0) * t / T, w0 + (w1 - w0) * t / T, t0 + (t1 - t0) * t / T)
        y, stop = advance(y, stop, lerp, with_friction, T)


print("scenario,row,phi_rad,theta_rad,motor_nm,velocity_x_mps,velocity_y_mps,position_x_m,position_y_m")
run("stopped", lambda t: (np.array([10.0, 20.0, 0.0]), 0.0, 0.03), 600, 20, False)
run("flight", flight, 800, 20, True)
