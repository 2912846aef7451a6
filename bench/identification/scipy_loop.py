"""SciPy's least_squares with finite differences around programs that give forces.

    scipy_loop.py calculix FOLDER     E and nu; ccx solves FOLDER/unit-P.inp, a unit press each
    scipy_loop.py hs-simulate FOLDER HS_SIMULATE    six parameters; one process an evaluation

FOLDER has data.csv, and start.csv for hs-simulate. Prints a JSON line: seconds, evaluations,
programs run, the values found, the error [N].
"""
import csv
import json
import os
import re
import subprocess
import sys

import numpy as np
from scipy.optimize import least_squares


def read(path):
    with open(path) as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    column = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    return column, np.stack([column["fx"], column["fy"], column["fz"]], axis=1)


def fit(forces, measured, start, lower, upper):
    """Unknowns in their logarithms over the start, so that one step suits all; away from 0, for
    SciPy takes its step relative to the unknown: 1e-3 of the value, which seven printed digits
    bear."""
    away = 10
    count = [0]

    def residuals(y):
        count[0] += 1
        return (forces(start * np.exp(y - away)) - measured).ravel()

    begin = sum(os.times()[:4])  # of the processor, of the programs run as well
    found = least_squares(residuals, np.full(len(start), float(away)), method="trf", diff_step=1e-4,
                          bounds=(away + np.log(lower / start), away + np.log(upper / start)))
    seconds = sum(os.times()[:4]) - begin
    rmse = np.sqrt(np.mean(found.fun ** 2))
    return {"seconds": seconds, "evaluations": count[0], "x": list(start * np.exp(found.x - away)),
            "rmse": rmse, "converged": bool(found.success)}


def calculix(folder):
    data, measured = read(os.path.join(folder, "data.csv"))
    press = data["press"].astype(int)
    presses = np.unique(press)
    u = np.stack([data["ux"], data["uy"], data["uz"]], axis=1)
    depth = np.linalg.norm(u, axis=1)
    runs = [0]
    decks = {p: open(os.path.join(folder, f"unit-{p}.inp")).read() for p in presses}
    environment = dict(os.environ, OMP_NUM_THREADS="1")

    def unit_force(p, modulus, nu):
        with open(os.path.join(folder, "run.inp"), "w") as out:
            out.write(re.sub(r"\*ELASTIC\n.*\n", f"*ELASTIC\n{modulus:.12e},{nu:.12e}\n", decks[p]))
        subprocess.run(["ccx", "run"], cwd=folder, check=True, env=environment,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        runs[0] += 1
        with open(os.path.join(folder, "run.dat")) as lines:
            numbers = [line.split() for line in lines if len(line.split()) == 3]
        return np.array([float(x) for x in numbers[-1]])  # what holds the patch

    def forces(x):
        result = np.zeros_like(measured)
        for p in presses:
            rows = press == p
            result[rows] = np.outer(depth[rows], unit_force(p, *x))
        return result

    result = fit(forces, measured, np.array([1e4, 0.3]), np.array([1.0, 1e-3]),
                 np.array([1e9, 0.49]))
    return dict(result, runs=runs[0])


def hs_simulate(folder, program):
    _, measured = read(os.path.join(folder, "data.csv"))
    with open(os.path.join(folder, "start.csv")) as lines:
        rows = [row for row in csv.reader(lines) if not row[0].startswith("#")]
    header, rows = rows[0], rows[1:]
    value = header.index("value")

    def forces(x):
        with open(os.path.join(folder, "trial.csv"), "w") as out:
            writer = csv.writer(out)
            writer.writerow(header)
            for row, number in zip(rows, x):
                writer.writerow(row[:value] + [repr(float(number))] + row[value + 1:])
        subprocess.run([program, "-q", "data.csv", "--body", "body.ply", "--model", "trial.csv",
                        "--cache", "cache", "--threads", "1", "-o", "trial-forces.csv"],
                       cwd=folder, check=True)
        return read(os.path.join(folder, "trial-forces.csv"))[1]

    start = np.array([float(row[value]) for row in rows])
    limits = {"E": (1, 1e9), "nu": (1e-3, 0.498), "E1": (1e-2, 1e9), "E2": (1e-2, 1e9),
              "tau1": (1e-3, 1e3), "tau2": (1e-3, 1e3)}
    names = [row[header.index("parameter")] for row in rows]
    result = fit(forces, measured, start, np.array([limits[n][0] for n in names]),
                 np.array([limits[n][1] for n in names]))
    return dict(result, runs=result["evaluations"])


print(json.dumps(calculix(sys.argv[2]) if sys.argv[1] == "calculix"
                 else hs_simulate(sys.argv[2], sys.argv[3])))
