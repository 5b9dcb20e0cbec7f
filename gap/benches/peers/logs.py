"""A log and the nominal parameters, as the peers see them."""

import tomllib

import numpy as np

G = 9.80665
# nominal parameters that are off, and by how much at most
TOLERANCE = {"load": 0.15}
SIGMA = {"gyro_angle_rad": 2e-6, "motor_torque_nm": 1e-5}


class Log:
    """Columns by name; a third of it is held out, the last."""

    def __init__(self, path):
        table = np.genfromtxt(path, delimiter=",", names=True)
        for name in table.dtype.names:
            setattr(self, name, np.ascontiguousarray(table[name]))
        self.rows = len(table)
        self.held_out = slice(2 * self.rows // 3, self.rows)
        self.fitted = slice(1000, 2 * self.rows // 3)


def nominal(path):
    """The model file as one dictionary."""
    with open(path, "rb") as file:
        tables = tomllib.load(file)
    return {key: value for table in ("servo", "gyro", "bearing", "unbalance") for key, value in tables[table].items()}


def levels(model, ax, ay, az):
    """Load and viscous torque of all bearings [N m]: Palmgren's (6.1), (6.2)."""
    b = model
    share = b["gimbal_weight_n"] / (b["count"] * G)
    axial, radial = b["preload_n"] + share * np.abs(az), share * np.hypot(ax, ay)
    equivalent = b["static_axial_factor"] * axial + b["static_radial_factor"] * radial
    edge = b["torque_axial_factor"] / (1 + b["torque_radial_factor"])
    low = b["torque_axial_factor"] * axial - b["torque_radial_factor"] * radial
    load = b["count"] * b["load_torque_nm_per_n"] * equivalent ** b["load_exponent"] * np.where(radial <= edge * axial, low, radial)
    viscous = b["count"] * b["lubrication_factor"] * b["pitch_diameter_m"] ** 3 * 3.492e-3 * 6894.757293168361
    return load, viscous


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))
