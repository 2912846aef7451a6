"""Causes in the set-up: what each makes of a recording that hides nothing.

kind: what has to be said where no name is found; fixed before anything was diagnosed. names: of the catalogue, that
mean the cause."""
import numpy as np


class Cause:
    """make(null, random) -> (head, u, f, noise) of the recording."""

    def __init__(self, name, kind, names, forces=None, motion=None, head=None, noise=None):
        self.name, self.kind, self.names = name, kind, names
        self.forces, self.motion, self.head, self.noise = forces, motion, head, noise

    def make(self, null, random):
        head = self.head(null.head) if self.head else null.head
        u = self.motion(null) if self.motion else null.u
        f = self.forces(null) if self.forces else null.f
        noise = self.noise(random, null) if self.noise else random.normal(0, null.noise, null.f.shape)
        return head, u, f, noise


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


SETUP, TIME = "set-up", "time"


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
        Cause("drifts-off", TIME, ["sensor-drift"], forces=drifting((0.05, -0.04, 0.1), 300)),
    ]
