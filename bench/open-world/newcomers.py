"""More causes that no effect of the catalogue covers, written down after the test of one size had its limit, which
those of strangers.py gave it; kinds, names and known as there, fixed before anything was diagnosed."""
import numpy as np

from causes import Cause, back_and_forth, presses
from strangers import BIAS, GAINS, RELAX, SIZES, after, depth, plus, share, since, sized, speed, times


def regrip(null):
    """Each press is gripped anew: a gain by chance."""
    random, factor = np.random.default_rng(11), np.ones(len(null.t))
    for rows in presses(null):
        factor[rows] = 1 + random.normal(0, 0.08)
    return factor


def cable(null):
    """A cable that pulls by where the arm stands."""
    p = null.x - null.x.mean(axis=0)
    return np.stack([0.5 * p[:, 0], 0.2 * p[:, 1], 0.8 * p[:, 0] * p[:, 1] / 0.05], axis=1)


def sideways_memory(null):
    """Only what is sheared relaxes."""
    f = null.f.copy()
    f[:, :2] = RELAX(null)[:, :2]
    return f


def creeps_away(null):
    """The body moves off sideways as long as it is pushed."""
    gone = np.zeros_like(null.u)
    for rows in presses(null):
        dt = np.diff(null.t[rows], prepend=null.t[rows[0]])
        gone[rows, :2] = np.cumsum(null.f[rows, :2] * dt[:, None], axis=0) * 1e-3
    return null.forces(null.u - gone)


def buckles(null):
    """A shell at some places gives way from 2.5 mm on."""
    d = np.maximum(depth(null), 1e-9)
    weak = null.x[:, 0] > np.median(null.x[:, 0])
    return np.where(weak & (d > 2.5e-3), (2.5e-3 + 0.3 * (d - 2.5e-3)) / d, 1)


def sucks(null):
    """On the way out the last millimetre is held back, by the speed."""
    out = (speed(null) > 1e-9) & (depth(null) < 1e-3)
    return np.outer(-np.abs(speed(null)) * out, (0, 0, 20))


def floor_shakes(null):
    """A machine next door runs in the third quarter of the session."""
    on = (share(null) > 0.5) & (share(null) < 0.75)
    return np.outer(np.sin(2 * np.pi * 4.3 * null.t) * on, (0.02, 0.02, 0.04))


def half_way(null):
    """Another tool from the middle of the session on."""
    return np.where(share(null) > 0.5, 0.8, 1.0)


def mistyped(null):
    """Two places have their numbers exchanged."""
    f = null.f.copy()
    places = np.unique(null.x, axis=0)
    a, b = places[0], places[len(places) // 2]
    at_a, at_b = (null.x == a).all(axis=1), (null.x == b).all(axis=1)
    f[at_a] = null.u[at_a] @ null.K[at_b][0].T
    f[at_b] = null.u[at_b] @ null.K[at_a][0].T
    return f


def one_way_slip(null):
    """Along +x the surface slips from 0.1 N on, the other way it holds."""
    f = null.f.copy()
    f[:, 0] = np.where(f[:, 0] > 0.1, 0.1 + 0.2 * (f[:, 0] - 0.1), f[:, 0])
    return f


def trains(null):
    """Every press, anywhere, stiffens all by a part of what is left to stiffen."""
    factor = np.ones(len(null.t))
    for k, rows in enumerate(presses(null)):
        factor[rows] = 1.3 - 0.3 * 0.8 ** k
    return factor


def deeper_relaxes_more(null):
    """The share that relaxes grows with the depth."""
    w = np.minimum(depth(null) / 4e-3, 1)[:, None]
    return (1 - w) * null.f + w * RELAX(null)


def squares(null):
    """Sideways axes take the square of the force along z."""
    return np.outer(null.f[:, 2] ** 2, (0.1, -0.05, 0))


def charge(null):
    """A charge is left when the tool turns back."""
    f = np.zeros_like(null.f)
    for rows in presses(null):
        back = np.flatnonzero(speed(null)[rows] > 1e-9)
        if len(back):
            f[rows[back[0]]:rows[-1] + 1] = (0.02, 0.01, 0.07)
    return f


def beats(null):
    """A vessel under the surface beats, and pushes the more the deeper it is pressed."""
    return 1 + 0.1 * np.sin(2 * np.pi * 1.2 * null.t)


def fatigue(null):
    """A motor that weakens in each hold."""
    still = np.abs(speed(null)) < 1e-9
    return 1 - 0.1 * np.minimum(since(null) / 2, 1) * still


PLAIN = [
    ("regrip", times(regrip), "session order event", GAINS, {}),
    ("cable", plus(cable), "place offset", ["tare"], {}),
    ("sideways-memory", sideways_memory, "history direction axes", ["viscoelastic"], {}),
    ("creeps-away", creeps_away, "history direction", ["viscoelastic", "friction"], {}),
    ("buckles", times(buckles), "place depth", [], {}),
    ("sucks", plus(sucks), "speed history", ["adhesion", "damper"], {"path": back_and_forth}),
    ("floor-shakes", plus(floor_shakes), "frequency session event", [], {}),
    ("half-way", times(half_way), "session order event", GAINS, {}),
    ("mistyped", mistyped, "place", ["learned-place", "regions"], {}),
    ("one-way-slip", one_way_slip, "direction axes", ["friction", "sensor-curve"], {}),
    ("trains", times(trains), "session order", GAINS, {}),
    ("deeper-relaxes-more", deeper_relaxes_more, "history depth", ["qlv", "viscoelastic"], {}),
    ("squares", plus(squares), "depth direction axes set-up", ["sensor-crosstalk"], {}),
    ("charge", plus(charge), "history offset", ["sensor-hysteresis"], {"path": back_and_forth}),
    ("beats", times(beats), "frequency", ["breathing"], {}),
    ("fatigue", times(fatigue), "history speed", ["viscoelastic"], {}),
]
MIXED = [
    ("relax-regrip", after(RELAX, times(regrip)), "session order event", "viscoelastic", GAINS, None),
    ("relax-buckles", after(RELAX, times(buckles)), "place depth", "viscoelastic", [], None),
    ("bias-beats", after(times(beats), BIAS), "frequency", "sensor-bias", ["breathing"], None),
    ("bias-charge", after(plus(charge), BIAS), "history offset", "sensor-bias", ["sensor-hysteresis"], back_and_forth),
]


def every_newcomer():
    found = [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
             for name, forces, kind, names, more in PLAIN for k in SIZES]
    return found + [Cause(name, kind, names, forces=forces, known=known.split(), path=path)
                    for name, forces, kind, known, names, path in MIXED]
