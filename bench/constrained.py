"""Called by constrained.sh in a folder with body.ply."""

import sys
import time

import numpy as np
from scipy.optimize import minimize

import hapsim

FIXED = {"tool_radius": 0.004, "rim_edge": 0.3, "noise": 0.01}
BODY = hapsim.Body.read("body.ply")
E, NU, E1, T1, E2, T2 = ("elastic.E", "elastic.nu", "viscoelastic.E1", "viscoelastic.tau1", "viscoelastic.E2",
                         "viscoelastic.tau2")
GX, GY = "sensor-gain.gx", "sensor-gain.gy"


def model(values):
    rows = [(name.split("."), value) for name, value in values.items()]
    return hapsim.Model.parse("effect,region,parameter,value\n" +
                              "".join(f"{e},0,{p},{v!r}\n" for (e, p), v in rows), "start")


def motion():
    """Six presses at three places: down, aside, held, and up, at three speeds."""
    rows = []
    for press in range(6):
        t = np.arange(0, 4, 0.01)
        speed = 1 + press % 3
        down = 0.003 * np.clip(np.minimum(speed * t, 4 - t), 0, 1)
        aside = 0.0015 * np.clip(t - 1.5, 0, 1) * (t < 3.5)
        angle = 2 * press
        x = np.full_like(t, 0.02 + 0.01 * (press % 3))
        rows.append(np.column_stack([np.full_like(t, press), t, x, np.full_like(t, 0.025), np.full_like(t, 0.04),
                                     aside * np.cos(angle), aside * np.sin(angle), -down]))
    table = np.vstack(rows)
    return {name: table[:, k].copy() for k, name in enumerate("press t x y z ux uy uz".split())}


def measured(truth, seed):
    clean = hapsim.simulate(hapsim.Recording({**motion(), **{f: np.zeros(2400) for f in ("fx", "fy", "fz")}},
                                             {"tool_radius": "0.004"}), BODY, model(truth), rim_edge=0.3, tool_radius=0.004)
    noise = np.random.default_rng(seed).normal(0, 0.01, (len(clean), 3))
    columns = motion()
    for k, axis in enumerate(("fx", "fy", "fz")):
        columns[axis] = clean[axis] + noise[:, k]
    return hapsim.Recording(columns, {"tool_radius": "0.004"})


def residuals(data, values):
    forces = hapsim.simulate(data, BODY, model(values), rim_edge=0.3, tool_radius=0.004)
    return (forces.f - data.f).ravel()


def reference(data, start, constraints):
    """SLSQP over x / start; derivatives of the residuals by central differences, of the constraints too. nu is free in
    all problems: where it is held, hs-identify prepares the body for that value alone, and hs-simulate for all."""
    names = list(start)
    size = np.array([start[n] for n in names])

    def at(y):
        return dict(zip(names, y * size))

    def r(y):
        return residuals(data, at(y)) / 0.01

    scale = 1e-3
    cache = {}

    def both(y):
        key = y.tobytes()
        if key not in cache:
            h = 1e-4
            base = r(y)
            J = np.column_stack([(r(y + h * e) - r(y - h * e)) / (2 * h) for e in np.eye(len(y))])
            cache[key] = (scale * base @ base, 2 * scale * J.T @ base)
        return cache[key]

    def slope(g):
        def by(y):
            h = 1e-5
            return np.array([(g(y + h * e) - g(y - h * e)) / (2 * h) for e in np.eye(len(y))])
        return by

    given = []
    for kind, formula in constraints:
        def g(y, formula=formula):
            return formula(at(y))
        given.append({"type": kind, "fun": g, "jac": slope(g)})
    y = np.ones(len(names))
    for _ in range(3):  # SLSQP ends early; it goes on from there
        found = minimize(lambda y: both(y)[0], y, jac=lambda y: both(y)[1], method="SLSQP", constraints=given,
                         bounds=[(0.05, 0.49 / start[NU] if n == NU else 20) for n in names], options={"ftol": 1e-15, "maxiter": 200})
        y = found.x
    return dict(zip(names, y * size))


def least_times(*calls):
    """What each call gives, and the least processor time of seven, in turn: another load of the machine must not count."""
    results, times = [None] * len(calls), [[] for _ in calls]
    for _ in range(7):
        for k, call in enumerate(calls):
            clock = time.process_time()
            results[k] = call()
            times[k].append(time.process_time() - clock)
    return results, [min(t) for t in times]


ONE = {E: 12e3, NU: 0.4, E1: 6e3, T1: 0.3}
TWO = {**ONE, E2: 3e3, T2: 3.0}
GAIN = {E: 12e3, NU: 0.42, GX: 1.1, GY: 0.9}
# The truth, all of it free; the constraint as hs-identify and as SLSQP have it (eq: 0, ineq: >= 0).
PROBLEMS = [
    (ONE, "E1 <= E/3", [("ineq", lambda p: p[E] / 3e3 - p[E1] / 1e3)]),
    (ONE, "E >= 2.5*E1", [("ineq", lambda p: p[E] / 1e3 - 2.5 * p[E1] / 1e3)]),
    (ONE, "E + E1 = 17.5 kPa", [("eq", lambda p: (p[E] + p[E1]) / 1e3 - 17.5)]),
    (ONE, "E + E1 <= 17.5 kPa; tau1 >= 0.31", [("ineq", lambda p: 17.5 - (p[E] + p[E1]) / 1e3),
           ("ineq", lambda p: p[T1] - 0.31)]),
    (ONE, "E1*tau1 = 2500", [("eq", lambda p: p[E1] * p[T1] / 1e3 - 2.5)]),
    (ONE, "E1*tau1 <= 1500", [("ineq", lambda p: 1.5 - p[E1] * p[T1] / 1e3)]),
    (ONE, "(E^2 + E1^2)^0.5 <= 12 kPa",
     [("ineq", lambda p: 12 - np.hypot(p[E], p[E1]) / 1e3)]),
    (ONE, "E1/E = tau1", [("eq", lambda p: p[E1] / p[E] - p[T1])]),
    (ONE, "E/(2*(1 + nu)) >= 4.6 kPa", [("ineq", lambda p: p[E] / (2e3 * (1 + p[NU])) - 4.6)]),
    (ONE, "E/(3*(1 - 2*nu)) = 18 kPa", [("eq", lambda p: p[E] / (3e3 * (1 - 2 * p[NU])) - 18)]),
    (ONE, "nu >= 0.43; E1 <= E/3", [("ineq", lambda p: 10 * p[NU] - 4.3),
           ("ineq", lambda p: p[E] / 3e3 - p[E1] / 1e3)]),
    (ONE, "nu = 0.3 + 0.1*tau1/0.2; E1 = E*nu", [("eq", lambda p: 10 * p[NU] - 3 - 5 * p[T1]),
           ("eq", lambda p: p[E1] / 1e3 - p[E] / 1e3 * p[NU])]),
    (TWO, "tau2 >= 15*tau1", [("ineq", lambda p: p[T2] / 15 - p[T1])]),
    (TWO, "E1 = E2", [("eq", lambda p: (p[E1] - p[E2]) / 1e3)]),
    (TWO, "E1 + E2 <= E/2", [("ineq", lambda p: (p[E] / 2 - p[E1] - p[E2]) / 1e3)]),
    (TWO, "3*tau1 <= tau2 <= 2; E1 >= 3*E2", [("ineq", lambda p: p[T2] - 3 * p[T1]),
           ("ineq", lambda p: 2 - p[T2]),
           ("ineq", lambda p: (p[E1] - 3 * p[E2]) / 1e3)]),
    (TWO, "(tau1*tau2)^0.5 = 1; E1/E2 = 1.5", [("eq", lambda p: np.sqrt(p[T1] * p[T2]) - 1),
           ("eq", lambda p: p[E1] / p[E2] - 1.5)]),
    (GAIN, "gx + gy = 1.98", [("eq", lambda p: p[GX] + p[GY] - 1.98)]),
    (GAIN, "1/gx + 1/gy <= 1.9", [("ineq", lambda p: 1.9 - 1 / p[GX] - 1 / p[GY])]),
    (GAIN, "gx*gy = 1.1; E <= 11.5 kPa", [("eq", lambda p: p[GX] * p[GY] - 1.1),
           ("ineq", lambda p: 11.5 - p[E] / 1e3)]),
]

recordings = {}
worst = slowest = 0
print("problem: parameters, largest relative difference from SLSQP, processor seconds with / without = times, the least of seven")
for number, (truth, formula, constraints) in enumerate(PROBLEMS, 1):
    key = tuple(truth)
    if key not in recordings:
        recordings[key] = measured(truth, len(recordings) + 1)
    data = recordings[key]
    start = model({n: v * (1.2 if n != NU else 1) for n, v in truth.items()})
    asked = {**FIXED, "folds": 0}

    def without():
        return hapsim.identify(data, BODY, start, **asked)

    def under():
        return hapsim.identify(data, BODY, start, constrain=formula, **asked)

    without()  # what is prepared is kept
    (_, fitted), (before, after) = least_times(without, under)
    known = reference(data, truth, constraints)
    if T2 in truth and known[T1] > known[T2]:  # the same terms, in the other order
        known[E1], known[T1], known[E2], known[T2] = known[E2], known[T2], known[E1], known[T1]
    off = max(abs(fitted[n] / known[n] - 1) for n in truth)
    binding = fitted.metadata.get("binding", "nothing")
    worst, slowest = max(worst, off), max(slowest, after / before)
    print(f"{number:2} {formula}: {len(truth)}, {off:.1e}, {after:.3f} / {before:.3f} = {after / before:.2f}; binds {binding}",
          flush=True)
print(f"\nall {len(PROBLEMS)}: largest difference {worst:.1e} (asked 1e-6), {slowest:.2f} times the time (asked 3)")
sys.exit(0 if worst <= 1e-6 and slowest <= 3 else 1)
