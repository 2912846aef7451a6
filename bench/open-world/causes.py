"""Causes in the set-up and in the material: what each makes of a recording that hides nothing.

kind: what has to be said where no name is found; fixed before anything was diagnosed. names: of the catalogue, that
mean the cause. known: of the catalogue, that act beside it."""
import copy

import numpy as np


class Cause:
    """make(null, random) -> (head, u, f) of the recording. path: how the tool moved, where otherwise than in the null's;
    forces and motion: what is measured of the forces and recorded of the motion; readings: what the sensor makes of
    forces with noise."""

    def __init__(self, name, kind, names, path=None, forces=None, motion=None, head=None, noise=None, readings=None,
                 known=()):
        self.name, self.kind, self.names, self.known = name, kind, names, known
        self.path, self.forces, self.motion, self.head, self.noise, self.readings = path, forces, motion, head, noise, readings

    def make(self, null, random):
        if self.path:
            null = copy.copy(null)
            null.u = self.path(null)
            null.f = null.forces(null.u)
        head = self.head(null.head) if self.head else null.head
        u = self.motion(null) if self.motion else null.u
        f = self.forces(null) if self.forces else null.f
        f = f + (self.noise(random, null) if self.noise else random.normal(0, null.noise, null.f.shape))
        return head, u, self.readings(f) if self.readings else f


def sensor(matrix):
    """The sensor shows matrix f."""
    return lambda null: null.f @ np.array(matrix).T


def arm(compliance):
    """The tool goes by the arm's compliance [m/N] along the axes further out than its drive, so less was recorded."""
    return lambda null: null.u - null.f * np.array(compliance)


def scale(factors):
    """The motion is recorded as factors times what it was."""
    return lambda null: null.u * np.array(factors)


def radius(share):
    """The header's radius of the tool, over the true one."""

    def head(lines):
        return ["# tool_radius: %g" % (share * float(h.split(":")[1])) if h.startswith("# tool_radius:") else h for h in lines]

    return head


def drag(size):
    """The guide along z takes that much [N] against the motion, and holds it at rest."""

    def forces(null):
        f, last = null.f.copy(), 0.0
        for i in range(1, len(f)):
            moved = null.u[i, 2] - null.u[i - 1, 2] if null.press[i] == null.press[i - 1] else 0.0
            last = -np.sign(moved) if moved else (last if null.press[i] == null.press[i - 1] else 0.0)
            f[i, 2] += size * last
        return f

    return forces


def drifting(size, tau):
    """A zero that goes to `size` [N] within some tau [s] of the session's start."""
    return lambda null: null.f + np.outer(1 - np.exp(-(null.t - null.t[0]) / tau), size)


def presses(null):
    """Rows of each press."""
    return [np.flatnonzero(null.press == p) for p in np.unique(null.press)]


def back_and_forth(null):
    """The hold is gone back in two steps, a third and all of the way, with half of the way in again between them."""
    u = null.u.copy()
    for rows in presses(null):
        deepest = null.u[rows[-1]]
        first = np.argmax(np.linalg.norm(null.u[rows], axis=1) > (1 - 1e-9) * np.linalg.norm(deepest))
        s = np.linspace(0, 1, len(rows) - first)
        u[rows[first:]] = np.interp(s, [0, 0.2, 0.4, 0.5, 0.65, 0.9, 1], [1, 1, 2 / 3, 2 / 3, 0.85, 0, 0])[:, None] * deepest
    return u


def slips(share, count=20):
    """A sensor whose strain follows the load through many small frictions (Maxwell slip), which give way one after the
    other: each carries its part of a load's reversal until that is as large as its own share of the press's load; what
    they hold back, scaled by the load, is `share` of it at most."""

    def forces(null):
        f = null.f.copy()
        for rows in presses(null):
            for k in range(3):
                load = np.abs(null.f[rows, k])
                top = max(load.max(), 1e-9)
                limits = top * np.linspace(0.02, 0.6, count)
                held = np.zeros(count)
                for i, row in enumerate(rows):
                    held = np.clip(held + load[i] - (load[i - 1] if i else 0.0), -limits, limits)
                    f[row, k] -= np.sign(null.f[row, k]) * share * load[i] * (held / limits).mean()
        return f

    return forces


def early(start, rate):
    """Forces are recorded that much [s] before their motion, and rate times the session's time more."""

    def forces(null):
        f = null.f.copy()
        for rows in presses(null):
            t = null.t[rows]
            for k in range(3):
                f[rows, k] = np.interp(t + start + rate * (t - null.t[0]), t, null.f[rows, k])
        return f

    return forces


def breathes(amplitude, frequency, phase):
    """The body goes up and down along z by amplitude [m]."""

    def forces(null):
        wave = np.sin(2 * np.pi * frequency * (null.t - null.t[0]) + phase)
        return null.f - null.forces(np.outer(wave, [0, 0, amplitude]))

    return forces


def smoothed(frequency, damping, parts=10):
    """A low-pass filter of second order, stepped in parts of a sample (Runge-Kutta of fourth order)."""
    w = 2 * np.pi * frequency

    def rate(y, v, load):
        return v, w * w * (load - y) - 2 * damping * w * v

    def forces(null):
        f = null.f.copy()
        for rows in presses(null):
            y, v = null.f[rows[0]].copy(), np.zeros(3)
            for a, b in zip(rows[:-1], rows[1:]):
                h = (null.t[b] - null.t[a]) / parts
                for i in range(parts):
                    now, middle, end = (null.f[a] + (null.f[b] - null.f[a]) * s / parts for s in (i, i + 0.5, i + 1))
                    k1 = rate(y, v, now)
                    k2 = rate(y + h / 2 * k1[0], v + h / 2 * k1[1], middle)
                    k3 = rate(y + h / 2 * k2[0], v + h / 2 * k2[1], middle)
                    k4 = rate(y + h * k3[0], v + h * k3[1], end)
                    y = y + h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
                    v = v + h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
                f[b] = y
        return f

    return forces


def remembers(kernel, power=0.0, depth=4e-3):
    """What was pressed is remembered: int kernel(t - s) dg(s), g the force times (|u| / depth)^power, summed step by step
    with the kernel at the middle of each."""

    def forces(null):
        f = null.f.copy()
        for rows in presses(null):
            t, g = null.t[rows], null.f[rows]
            if power:
                g = g * ((np.linalg.norm(null.u[rows], axis=1) / depth) ** power)[:, None]
            steps, middle = np.diff(g, axis=0), (t[1:] + t[:-1]) / 2
            for i in range(len(rows)):
                f[rows[i]] += kernel(t[i] - t[0]) * g[0] + kernel(t[i] - middle[:i]) @ steps[:i]
        return f

    return forces


def heavy_tool(mass):
    """The tool's mass times its acceleration, by differences to both sides of each sample."""

    def forces(null):
        f = null.f.copy()
        for rows in presses(null):
            t, u = null.t[rows], null.u[rows]
            v = np.diff(u, axis=0) / np.diff(t)[:, None]
            a = np.diff(v, axis=0) / ((t[2:] - t[:-2]) / 2)[:, None]
            f[rows[1:-1]] -= mass * a
        return f

    return forces


def stays(share, yields):
    """Of what is deeper than `yields` [m] that share stays, for good, at each place."""

    def path(null):
        u, deepest = null.u.copy(), {}
        for rows in presses(null):
            key = tuple(null.x[rows[0]])
            for row in rows:
                q = np.linalg.norm(null.u[row])
                deepest[key] = max(deepest.get(key, 0.0), q)
                gone = share * max(0.0, deepest[key] - yields)
                u[row] = null.u[row] * (1 - gone / q) if q > gone else 0.0
        return null.forces(u)

    return path


def larger(factor):
    return lambda random, null: random.normal(0, factor * null.noise, null.f.shape)


def coloured(rho):
    """Neighbouring samples correlated by rho."""

    def noise(random, null):
        e = random.normal(0, null.noise, null.f.shape)
        for i in range(1, len(e)):
            e[i] = rho * e[i - 1] + np.sqrt(1 - rho * rho) * e[i]
        return e

    return noise


def heavy(random, null):
    """Student's t of four degrees, of the same variance."""
    return null.noise * random.standard_t(4, null.f.shape) / np.sqrt(2)


def declared(factor):
    return lambda lines: ["# force_noise: %g" % (factor * float(h.split(":")[1])) if h.startswith("# force_noise:") else h
                          for h in lines]


SETUP, TIME, SENSOR = "set-up", "time", "depth"
MEMORY = ["viscoelastic", "fractional", "learned-kernel"]


def every_cause():
    return [
        Cause("null", "", []),
        Cause("null-noisy", "", [], head=declared(5), noise=larger(5)),
        Cause("null-coloured", "", [], noise=coloured(0.3)),
        Cause("null-heavy", "", [], noise=heavy),
        Cause("crosstalk", SETUP, ["sensor-crosstalk"],
              forces=sensor([[1, 0.09, -0.09], [-0.05, 1, 0.09], [0.06, 0.09, 1]])),
        Cause("leak", SETUP, ["sensor-crosstalk"], forces=sensor([[1, 0, 0.09], [0, 1, -0.06], [0, 0, 1]])),
        Cause("leak-small", SETUP, ["sensor-crosstalk"], forces=sensor([[1, 0, 0.03], [0, 1, 0.03], [0, 0, 1]])),
        Cause("arm", SETUP, ["arm-compliance"], motion=arm([4e-3, 4e-3, 4e-3])),
        Cause("arm-axial", SETUP, ["arm-compliance"], motion=arm([0, 0, 2e-3])),
        Cause("arm-sideways", SETUP, ["arm-compliance"], motion=arm([4e-3, 0.5e-3, 0])),
        Cause("scale-y", SETUP, ["motion-scale"], motion=scale([1, 1.15, 1])),
        Cause("scale-z", SETUP, ["motion-scale"], motion=scale([1, 1, 1.15])),
        Cause("radius-5", SETUP, ["tool-radius"], head=radius(4 / 5)),
        Cause("radius-8", SETUP, ["tool-radius"], head=radius(4 / 8)),
        Cause("drag", SETUP, ["drag"], forces=drag(0.06)),
        Cause("clips", SENSOR, ["clipping"], readings=lambda f: np.clip(f, -0.7, 0.7)),
        Cause("clips-late", SENSOR, ["clipping"], readings=lambda f: np.clip(f, -1.1, 1.1)),
        Cause("null-returns", "", [], path=back_and_forth),
        Cause("lags-load", TIME, ["sensor-hysteresis"], path=back_and_forth, forces=slips(0.08)),
        Cause("early", TIME, ["clock"], forces=early(0.07, 0)),
        Cause("clock-runs", TIME, ["clock"], forces=early(0.01, 5e-5)),
        Cause("breathes", TIME, ["breathing"], forces=breathes(0.2e-3, 0.23, 1.0)),
        Cause("trembles", TIME, ["breathing"], forces=breathes(0.06e-3, 3.1, -0.5)),
        Cause("filtered", TIME, ["filter"], forces=smoothed(2.5, 0.6)),
        Cause("filtered-fast", TIME, ["filter"], forces=smoothed(6, 0.866)),
        Cause("drifts-off", TIME, ["sensor-settling"], forces=drifting((0.05, -0.04, 0.1), 300)),
        Cause("power-memory", TIME, MEMORY, forces=remembers(lambda s: 0.6 * (1 + s / 0.05) ** -0.3)),
        Cause("drains", TIME, MEMORY + ["poroelastic"],
              forces=remembers(lambda s: 0.5 * (1.304 * np.exp(-np.sqrt(s / 1.3)) - 0.304 * np.exp(-0.254 * s / 1.3)))),
        Cause("qlv", TIME, ["qlv"], forces=remembers(lambda s: 0.8 * np.exp(-s / 0.7), power=0.8)),
        Cause("sets", SENSOR, ["plastic"], path=back_and_forth, forces=stays(0.2, 0.5e-3)),
        Cause("heavy-tool", TIME, ["tool-inertia"], forces=heavy_tool(2.0)),
        Cause("settles-soon", TIME, ["sensor-settling"], forces=drifting((0.02, 0, 0.06), 80)),
    ]
