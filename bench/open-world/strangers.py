"""Causes that no effect of the catalogue covers, each in three sizes, some beside an effect that has a name.

kind: words of table.py, any of which may be said of it; names: effects that would mean it all the same; known: effects
that truly act beside it. All three were fixed before anything was diagnosed."""
import copy

import numpy as np

from causes import Cause, back_and_forth, presses, remembers


def share(null):
    """0 to 1 along the session."""
    return (null.t - null.t[0]) / (null.t[-1] - null.t[0])


def times(factor):
    """Forces times factor(null), (n)."""
    return lambda null: null.f * factor(null)[:, None]


def plus(force):
    """Forces and force(null), (n, 3), beside them."""
    return lambda null: null.f + force(null)


def speed(null):
    """Of the tool along z, backward over a sample [m/s]."""
    v = np.zeros(len(null.t))
    for rows in presses(null):
        v[rows[1:]] = np.diff(null.u[rows, 2]) / np.diff(null.t[rows])
    return v


def depth(null):
    return np.linalg.norm(null.u, axis=1)


def since(null):
    """Time since the press began [s]."""
    s = np.zeros(len(null.t))
    for rows in presses(null):
        s[rows] = null.t[rows] - null.t[rows[0]]
    return s


def ramp_ends(null):
    """Row of each press at which the tool first stops."""
    ends = []
    for rows in presses(null):
        still = np.linalg.norm(null.u[rows] - null.u[rows[-1]], axis=1) < 1e-9
        ends.append(rows[np.argmax(still)])
    return ends


def recovers(null):
    """Each press, wherever, softens all by its part, which recovers in 150 s."""
    factor, lost, last = np.ones(len(null.t)), 0.0, null.t[0]
    for rows in presses(null):
        lost *= np.exp(-(null.t[rows[0]] - last) / 150)
        factor[rows] = 1 - lost
        lost, last = lost + 0.06, null.t[rows[-1]]
    return factor


def counted(null):
    """The n-th press of a place is softer by what does not depend on how deep the others were."""
    factor, count = np.ones(len(null.t)), {}
    for rows in presses(null):
        key = tuple(null.x[rows[0]])
        n = count.get(key, 0)
        factor[rows] = 0.8 + 0.2 * 0.5 ** n
        count[key] = n + 1
    return factor


def step_at(press, until=None):
    """A zero that jumps in the middle of a press; until: "end" of that press, else for good."""

    def force(null):
        rows = presses(null)[press]
        f = np.zeros_like(null.f)
        f[rows[len(rows) // 2]: rows[-1] + 1 if until else None] = (0.03, -0.02, 0.08)
        return f

    return force


def walks(null):
    """A zero that takes a step of chance between presses."""
    random, f, zero = np.random.default_rng(7), np.zeros_like(null.f), np.zeros(3)
    for rows in presses(null):
        f[rows] = zero
        zero = zero + random.normal(0, 0.02, 3)
    return f


def aftereffect(null):
    """A zero that keeps a part of what was carried before, and loses it within a minute."""
    f, kept, last = np.zeros_like(null.f), np.zeros(3), null.t[0]
    for rows in presses(null):
        kept = kept * np.exp(-(null.t[rows[0]] - last) / 60)
        f[rows] = kept * np.exp(-since(null)[rows] / 60)[:, None]
        kept, last = kept + 0.1 * null.f[rows[-1]], null.t[rows[0]]
    return f


def waits(null):
    """Every second sample is the one before it."""
    f = null.f.copy()
    for rows in presses(null):
        f[rows[1::2]] = f[rows[0:2 * len(rows[1::2]):2]]
    return f


def shifted(null, offsets):
    """The forces of times that are later by offsets (n) [s]."""
    f = null.f.copy()
    for rows in presses(null):
        for k in range(3):
            f[rows, k] = np.interp(null.t[rows] + offsets[rows], null.t[rows], null.f[rows, k])
    return f


def jitters(null):
    return shifted(null, np.random.default_rng(3).normal(0, 0.008, len(null.t)))


def late(null):
    """Each press's forces begin by chance up to 0.08 s late."""
    random, offsets = np.random.default_rng(4), np.zeros(len(null.t))
    for rows in presses(null):
        offsets[rows] = -random.uniform(0, 0.08)
    return shifted(null, offsets)


def hum(null):
    """A line and its harmonic, on all axes, pressed or not."""
    w = 2 * np.pi * 7.3 * null.t
    return np.outer(np.sin(w), (0.03, 0.02, 0.03)) + np.outer(np.sin(2 * w + 1), (0.01, 0.015, 0.01))


def wraps(null):
    """A converter whose range ends at 1.1 N and which goes on from the other end."""
    return (null.f + 1.1) % 2.2 - 1.1


def sticks(null):
    """While the tool moves the force lags, then leaps, by teeth of 3 to 12 samples and a share of the force."""
    random, f = np.random.default_rng(5), null.f.copy()
    v = np.abs(speed(null)) > 1e-9
    for rows in presses(null):
        left, length = 0, 1
        for row in rows:
            if left == 0:
                left = length = int(random.integers(3, 13))
            if v[row]:
                f[row] *= 1 - 0.15 * (length - left) / length
            left -= 1
    return f


def second_contact(null):
    """The holder touches what is about it from 4 mm on."""
    f = null.f.copy()
    f[:, 2] += 150 * np.maximum(0, -null.u[:, 2] - 4e-3)
    return f


def knee(null):
    """From 2 mm on the force grows at six tenths of the rate."""
    d = np.maximum(depth(null), 1e-9)
    return np.where(d > 2e-3, (2e-3 + 0.6 * (d - 2e-3)) / d, 1)


def base_slides(null):
    """Sideways the body gives way on its base from 0.2 N on."""
    f = null.f.copy()
    side = np.linalg.norm(f[:, :2], axis=1)
    f[:, :2] *= np.where(side > 0.2, (0.2 + 0.3 * (side - 0.2)) / np.maximum(side, 1e-9), 1)[:, None]
    return f


def rings(null):
    """After the tool has stopped the sensor rings along z, by how fast it came."""
    f = null.f.copy()
    for rows, end in zip(presses(null), ramp_ends(null)):
        after = rows[rows >= end]
        s = null.t[after] - null.t[end]
        v = null.u[end, 2] / max(null.t[end] - null.t[rows[0]], 1e-9)
        f[after, 2] += 3 * v * np.exp(-s / 0.2) * np.cos(2 * np.pi * 6.1 * s)
    return f


def swapped(null):
    """Two places have each other's forces: the least and the most stiff."""
    places = np.unique(null.x, axis=0)
    stiff = [np.trace(null.K[(null.x == p).all(axis=1)][0]) for p in places]
    a, b = places[np.argmin(stiff)], places[np.argmax(stiff)]
    at_a, at_b = (null.x == a).all(axis=1), (null.x == b).all(axis=1)
    f = null.f.copy()
    f[at_a] = null.u[at_a] @ null.K[at_b][0].T
    f[at_b] = null.u[at_b] @ null.K[at_a][0].T
    return f


def some(numbers, change):
    """change(f, rows, null) in these presses alone."""

    def forces(null):
        f, all_rows = null.f.copy(), presses(null)
        for k in numbers:
            change(f, all_rows[k], null)
        return f

    return forces


def tenfold(f, rows, null):
    f[rows] *= 0.4


def slid_off(f, rows, null):
    f[rows[2 * len(rows) // 3:]] = 0


def tilted(angle_deg):
    """The motion is written in axes of a tool that is turned about y."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return lambda null: null.forces(null.u @ turn.T)


def lump_between(null):
    """Stiffer beyond a line that no place is near."""
    return 1 + 0.4 / (1 + np.exp(-(null.x[:, 1] - 0.14) / 4e-3))


def by_place(null):
    """A sensor whose gain goes with the pose of the arm."""
    return 1 + 0.1 * (null.x[:, 1] - null.x[:, 1].mean()) / np.ptp(null.x[:, 1]) * 2


def tenses(null):
    """0.6 s after it was pressed by 2 mm a muscle tenses, as far as it is pressed."""
    rise = np.zeros(len(null.t))
    for rows in presses(null):
        deep = np.flatnonzero(depth(null)[rows] > 2e-3)
        if len(deep):
            s = null.t[rows] - null.t[rows[deep[0]]] - 0.6
            rise[rows] = np.maximum(0, 1 - np.exp(-np.maximum(s, 0) / 0.2))
    return 1 + 0.15 * rise


def unloads(null):
    """On the way out forces read larger."""
    return 1 + 0.12 * (speed(null) > 1e-9)


def fades(null):
    """A battery: forces lose a share from the middle of the session on, steeper and steeper."""
    return 1 - 0.2 * np.maximum(0, 2 * share(null) - 1) ** 2


def touches(null):
    """Each press's surface was declared by chance up to 0.5 mm too soon."""
    random, f = np.random.default_rng(6), null.f.copy()
    for rows in presses(null):
        d = depth(null)[rows]
        gone = random.uniform(0, 0.5e-3)
        f[rows] *= (np.maximum(0, d - gone) / np.maximum(d, 1e-9))[:, None]
    return f


def rounds(null):
    """A converter of steps of 0.15 N."""
    return np.round(null.f / 0.15) * 0.15


def starts_loose(null):
    """A tool that is loose for the first ten presses: 0.3 mm of each press are lost."""
    f = null.f.copy()
    for rows in presses(null)[:10]:
        d = depth(null)[rows]
        f[rows] *= (np.maximum(0, d - 0.3e-3) / np.maximum(d, 1e-9))[:, None]
    return f


def flipped(axis):
    def forces(null):
        f = null.f.copy()
        f[:, axis] *= -1
        return f

    return forces


def larger_with_force(random, null):
    return random.normal(0, 1, null.f.shape) * (null.noise + 0.04 * np.abs(null.f))


def bursts(random, null):
    """Interference: one sample in thirty is off by chance."""
    f = random.normal(0, null.noise, null.f.shape)
    hit = random.random(len(f)) < 1 / 30
    f[hit] += random.uniform(-0.4, 0.4, (hit.sum(), 3))
    return f


def lost(random, null):
    """One sample in forty is not there and reads nothing."""
    f = random.normal(0, null.noise, null.f.shape)
    hit = random.random(len(f)) < 1 / 40
    f[hit] = -null.f[hit]
    return f


def sized(forces, size):
    """What they change, less what a common gain would, as `size` times the noise."""

    def change(null):
        d = forces(null) - null.f
        own = d - null.f * (d * null.f).sum() / (null.f ** 2).sum()
        return null.f + d * size * null.noise / np.sqrt((own ** 2).mean())

    return change


def after(first, second):
    """The second on what the first has made of the forces."""

    def forces(null):
        then = copy.copy(null)
        then.f = first(null)
        return second(then)

    return forces


RELAX = remembers(lambda s: 0.6 * np.exp(-s / 0.8))
BIAS = plus(lambda null: np.tile((0.04, -0.03, 0.08), (len(null.t), 1)))
OFFSETS, GAINS = ["learned-drift"], ["learned-gain"]

# name, forces, kind, names, then what Cause takes besides.
PLAIN = [
    ("warms", times(lambda n: 1 - 0.2 * (n.t - n.t[0]) / 300 * np.exp(1 - (n.t - n.t[0]) / 300)), "session", GAINS, {}),
    ("dries", times(lambda n: 1 + 0.3 * (1 - np.exp(-((n.t - n.t[0]) / 800) ** 2))), "session", GAINS, {}),
    ("fades", times(fades), "session", GAINS, {}),
    ("room", times(lambda n: 1 + 0.1 * np.sin(2 * np.pi * n.t / 500)), "session", GAINS, {}),
    ("recovers", times(recovers), "session order", [], {}),
    ("counted", times(counted), "order", ["softening"], {}),
    ("step", plus(step_at(14)), "session offset event", OFFSETS + ["tare"], {}),
    ("step-back", plus(step_at(14, "end")), "offset event", ["tare"], {}),
    ("walks", plus(walks), "session offset", OFFSETS + ["tare"], {}),
    ("aftereffect", plus(aftereffect), "session offset order", ["tare"], {}),
    ("pump", plus(lambda n: np.outer(np.sin(2 * np.pi * n.t / 700), (0, 0, 0.06))), "session offset", OFFSETS + ["tare"], {}),
    ("waits", waits, "history speed", [], {}),
    ("jitters", jitters, "noise history speed", [], {}),
    ("late", late, "history speed", [], {}),
    ("hum", plus(hum), "frequency", ["sensor-hum"], {}),
    ("wraps", wraps, "depth event", [], {}),
    ("rounds", rounds, "depth", [], {}),
    ("unloads", times(unloads), "history", ["sensor-hysteresis"], {"path": back_and_forth}),
    ("sticks", sticks, "event history speed", [], {}),
    ("speed-squared", plus(lambda n: np.outer(-np.abs(speed(n)) * speed(n), (0, 0, 150))), "speed history", ["damper"], {}),
    ("second-contact", second_contact, "depth", ["learned-depth"], {}),
    ("knee", times(knee), "depth", ["learned-depth"], {}),
    ("base-slides", base_slides, "direction", ["friction"], {}),
    ("rings", rings, "history event frequency", ["filter"], {}),
    ("swapped", swapped, "place", ["learned-place"], {}),
    ("unit-slip", some((5, 12, 20), tenfold), "event order", [], {}),
    ("slid-off", some((16,), slid_off), "event", [], {}),
    ("tilted", tilted(10), "set-up", ["motion-rotation", "sensor-rotation", "sensor-crosstalk"], {}),
    ("lump-between", times(lump_between), "place", ["regions", "inclusion", "learned-place"], {}),
    ("by-place", times(by_place), "place", ["learned-place", "regions"], {}),
    ("tenses", times(tenses), "history depth", ["learned-kernel"], {}),
    ("touches", touches, "depth offset", [], {}),
    ("loose", starts_loose, "session depth", [], {}),
    ("flipped", flipped(1), "axes set-up", ["sensor-gain", "sensor-crosstalk"], {}),
]
MIXED = [
    ("relax-hum", after(RELAX, plus(hum)), "frequency", "viscoelastic", ["sensor-hum"]),
    ("relax-second", after(RELAX, second_contact), "depth", "viscoelastic", ["learned-depth"]),
    ("relax-warms", after(RELAX, PLAIN[0][1]), "session", "viscoelastic", GAINS),
    ("relax-sticks", after(RELAX, sticks), "event history speed", "viscoelastic", []),
    ("bias-knee", after(times(knee), BIAS), "depth", "sensor-bias", ["learned-depth"]),
    ("bias-late", after(late, BIAS), "history speed", "sensor-bias", []),
    ("bias-slides", after(base_slides, BIAS), "direction", "sensor-bias", ["friction"]),
    ("relax-lump", after(times(lump_between), RELAX), "place", "viscoelastic", ["regions", "inclusion", "learned-place"]),
]
SIZES = 2, 4, 8


def every_stranger():
    found = [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
             for name, forces, kind, names, more in PLAIN for k in SIZES]
    found += [Cause(name, kind, names, forces=forces, known=known.split()) for name, forces, kind, known, names in MIXED]
    found += [
        Cause("noise-with-force", "noise", [], noise=larger_with_force),
        Cause("bursts", "noise event", [], noise=bursts),
        Cause("lost", "noise event", [], noise=lost),
    ]
    return found
