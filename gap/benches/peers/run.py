"""`gimbal gap` and its peers on the same logs: time, memory, effect found, error on what was not fitted.

    cargo build --release -p gimbal-cli && cargo build --release -p gimbal-gap --example log
    python3 gap/benches/peers/run.py            # prints the table of docs/benchmarks.md
    python3 gap/benches/peers/run.py gimbal     # its rows of `gimbal gap` alone, without installing anything

Peers are installed by pip into peers/ of the target folder, in the versions of requirements.txt. Every method is a process of its
own; memory is its largest resident set. Compilation of the peers' simulation (numba) is not counted.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", HERE.parents[2] / "target")).resolve()
SECONDS = 60
# excitation, seed, effect, values
CASES = [
    ("manoeuvre", 31, "none", ""),
    ("table", 32, "stribeck", "3e-4,0.03"),
    ("flight", 34, "cable_spring", "2e-4"),
    ("manoeuvre", 35, "torque_ripple", "1e-4,17,0.5"),
    ("manoeuvre", 36, "mass_unbalance", "8e-6,5e-6"),
    ("flight", 37, "loop_delay", "1e-4"),
    ("manoeuvre", 38, "gyro_damping", "0.1"),
]
# columns of the torque balance that stand for several effects
SAME = {"gyro": {"gyro_damping", "angular_momentum"}, "viscosity": {"viscous_friction"}}


def set_up():
    """The peers' Python; this script again in it."""
    folder = TARGET / "peers"
    python = folder / "bin" / "python"
    if Path(sys.prefix) == folder:
        return
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    subprocess.run([python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "-r", HERE / "requirements.txt"], check=True)
    os.execv(python, [python, __file__, *sys.argv[1:]])


def measured(command):
    """Seconds by the clock, seconds on processors, peak memory [MB], standard output."""
    start = time.perf_counter()
    with tempfile.TemporaryFile() as out:
        process = subprocess.Popen([str(part) for part in command], stdout=out, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.perf_counter() - start
        out.seek(0)
        text = out.read().decode()
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(str(part) for part in command)}: status {process.returncode}")
    return seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, text


def gimbal(log, effect):
    seconds, busy, memory, text = measured([TARGET / "release" / "gimbal", "gap", log, "--json"])
    report = json.loads(text)
    names = [found["name"] for found in report["effects"]]
    others = [name for other in report["alternatives"] for name in other["effects"]]
    if report["verdict"] == "cannot_tell":
        found = "one of " + ", ".join(dict.fromkeys(names + others))
    else:
        found = " + ".join(names) or {"no_gap": "none"}.get(report["verdict"], report["verdict"])
    mark = "right" if found == effect else "in its class" if effect in names + others else "WRONG"
    signal = report["shrink"]["signals"][0]
    return seconds, busy, memory, f"{mark}: {found}", f"{signal['before']:.1e} to {signal['after']:.1e} rad"


def sindy(kind):
    def run(log, effect):
        seconds, busy, memory, text = measured([sys.executable, HERE / "sindy.py", log, MODEL, kind])
        own = json.loads(text)
        right = own["found"] == effect or effect in SAME.get(own["found"], ())
        found = f"{'right' if right else 'WRONG'}: {own['found']}, {own['terms']} terms"
        return seconds, busy, memory, found, f"{own['before']:.1e} to {own['after']:.1e} N m"

    return run


def least_squares(log, effect):
    seconds, busy, memory, text = measured([sys.executable, HERE / "fit.py", log, MODEL, effect])
    own = json.loads(text)
    values = ", ".join(f"{value:.3g}" for value in own["values"].values())
    return seconds, busy, memory, f"told: {values or '-'}", f"{own['before']:.1e} to {own['after']:.1e} rad"


ALONE = sys.argv[1:] == ["gimbal"]
METHODS = [
    ("`gimbal gap`", gimbal),
    ("pysindy STLSQ", sindy("STLSQ")),
    ("pysindy FROLS", sindy("FROLS")),
    ("`least_squares`, true model", least_squares),
]
if ALONE:
    METHODS = METHODS[:1]
MODEL = TARGET / "peers" / "model.toml"


def main():
    if not ALONE:
        set_up()
    MODEL.parent.mkdir(exist_ok=True)
    subprocess.run([TARGET / "release" / "gimbal", "model", "--out", MODEL], check=True, stdout=subprocess.DEVNULL)
    logs = TARGET / "peers" / "logs"
    logs.mkdir(exist_ok=True)
    paths = []
    for excitation, seed, effect, values in CASES:
        path = logs / f"{seed}-{effect}.csv"
        with open(path, "w") as file:
            given = [] if effect == "none" else [f"{effect}={values}"]
            example = TARGET / "release" / "examples" / "log"
            subprocess.run([example, excitation, str(SECONDS), str(seed), "0.6", *given], stdout=file, check=True)
        paths.append(path)
    if not ALONE:
        # the simulation is compiled once and kept
        subprocess.run([sys.executable, HERE / "fit.py", paths[0], MODEL, "none"], check=True, stdout=subprocess.DEVNULL)
    print("| log | method | seconds | on processors | MB | effect | error before, after, on what was not fitted |")
    print("|---|---|---|---|---|---|---|")
    busy = {name: [] for name, _ in METHODS}
    for (excitation, _, effect, values), path in zip(CASES, paths):
        for name, method in METHODS:
            seconds, own, memory, found, error = method(path, effect)
            busy[name].append(own)
            log = f"{excitation}, {effect} {values}".strip()
            print(f"| {log} | {name} | {seconds:.1f} | {own:.1f} | {memory:.0f} | {found} | {error} |", flush=True)
            print(f"{log}: {name} done", file=sys.stderr)
    print("\n| method | median s on processors | ratio to `gimbal gap`, log by log, median |\n|---|---|---|")
    for name, _ in METHODS:
        ratios = sorted(own / ours for own, ours in zip(busy[name], busy["`gimbal gap`"]))
        print(f"| {name} | {sorted(busy[name])[len(CASES) // 2]:.1f} | {ratios[len(CASES) // 2]:.2f} |")


main()
