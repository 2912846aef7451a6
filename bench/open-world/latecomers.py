"""Causes that no effect of the catalogue covers, of the laboratory, of the tool, of the body and
of time by six each, written down from the catalogue's list and the files of the causes before
them alone; kinds and names as in strangers.py, fixed before anything was diagnosed."""
import numpy as np

from callers import nearer, ways
from causes import Cause, back_and_forth, presses
from drifters import fastest, off_middle
from guests import pauses
from strangers import GAINS, OFFSETS, SIZES, depth, plus, share, shifted, since, sized, times
from visitors import along_surface, normals


def off_axis(null):
    """A cell made for loads on its axis: one beside it shows in the axes across as well, by how far it is off."""
    lever = null.x - (null.x.max(axis=0) + null.x.min(axis=0)) / 2
    return np.column_stack([-3 * lever[:, :2] * null.f[:, 2:], np.zeros(len(null.t))])


def two_logs(null):
    """Two programs log the same sensor, one of them 0.24 s behind; what is stored is the mean of both."""
    return (null.f + shifted(null, np.full(len(null.t), -0.24))) / 2


def slow_channel(null):
    """The axis along z is read once while the others are read eight times; till then its last value stays."""
    f = null.f.copy()
    for rows in presses(null):
        f[rows, 2] = null.f[rows[np.arange(len(rows)) // 8 * 8], 2]
    return f


def imputed(null):
    """A radio loses half a second early in most presses; a script fills that in with the mean of the press."""
    random, f = np.random.default_rng(71), null.f.copy()
    for rows in presses(null):
        s, lost = since(null)[rows] - random.uniform(-0.2, 0.8), random.random() < 0.8
        f[rows[lost & (s >= 0) & (s < 0.5)]] = null.f[rows].mean(axis=0)
    return f


def afloat(null):
    """The laboratory is on a small boat that rolls and pitches; the tool's weight pulls to the side that is low."""
    w = 2 * np.pi * null.t
    return np.stack([0.09 * np.sin(0.71 * w), 0.05 * np.sin(0.93 * w + 1), 0 * w], axis=1)


def table_typo(null):
    """In the table from volts to newtons, by 0.25 N each, a 5 was typed as a 7: 0.70 N is where 0.50 N should be."""
    right = np.arange(0, 2.1, 0.25)
    typed = np.where(right == 0.5, 0.7, right)
    return np.sign(null.f) * np.interp(np.abs(null.f), right, typed)


def end_stop(null):
    """The tool's slide has a stop that nobody knows of: it goes in by 4 mm and no further, whatever is ordered."""
    return null.forces(null.u * np.minimum(1, 4e-3 / np.maximum(depth(null), 1e-9))[:, None])


def speed_limit(null):
    """A robot among people goes by 6 mm/s at most; what it was ordered is recorded, however fast that was."""
    u = null.u.copy()
    for rows in presses(null):
        for a, b in zip(rows[:-1], rows[1:]):
            step = null.u[b] - u[a]
            u[b] = u[a] + step * min(1, 6e-3 * (null.t[b] - null.t[a]) / max(np.linalg.norm(step), 1e-9))
    return null.forces(u)


def slips_free(null):
    """Pushed sideways by a fifth of its load the tool slips, at once, till half of that is left, and holds anew."""
    n, f = normals(null), null.f.copy()
    side, load = along_surface(null.f, n), np.abs((null.f * n).sum(axis=1))
    for rows in presses(null):
        slid = np.zeros(3)
        for row in rows:
            held = side[row] - slid
            if np.linalg.norm(held) > 0.18 * load[row] + 0.02:
                slid = slid + 0.5 * held
            f[row] -= slid
    return f


def own_weight(null):
    """Wrist and sensor tilt to the press' way, but the tool's weight is taken off as if they were upright."""
    return 0.15 * (np.array([0, 0, -1.0]) - ways(null))


def aquaplanes(null):
    """Pressed fast on a wet skin the tool floats on water, and sideways nothing holds it till that is squeezed out."""
    side, f = along_surface(null.f, normals(null)), null.f.copy()
    for rows in presses(null):
        floats = np.clip((fastest(null, rows) - 4e-3) / 4e-3, 0, 1) * np.exp(-(since(null)[rows] / 2) ** 2)
        f[rows] -= 0.9 * floats[:, None] * side[rows]
    return f


def stalls(null):
    """In one press of four or so, by chance, the motor stalls at three quarters of the way, and nobody sees it."""
    random, factor = np.random.default_rng(72), np.ones(len(null.t))
    for rows in presses(null):
        s = depth(null)[rows] / depth(null)[rows].max()
        if random.random() < 0.3:
            factor[rows] = np.minimum(1, 0.75 / np.maximum(s, 1e-9))
    return factor


def comes_back(null):
    """Of a dent in dough three fifths come back by 0.3 mm/s at most: a tool that goes out faster is followed less."""
    d, factor = depth(null), np.ones(len(null.t))
    for rows in presses(null):
        dent = 0.6 * d[rows[0]]
        for a, b in zip(rows[:-1], rows[1:]):
            dent = max(0.6 * d[b], dent - 0.3e-3 * (null.t[b] - null.t[a]))
            factor[b] = max(0.0, 1 - (dent - 0.6 * d[b]) / max(d[b], 1e-9))
    return factor


def vaulted(null):
    """The body is hollow under its middle, like a vault, and gives way more there than towards its edges."""
    away = np.linalg.norm(off_middle(null)[:, :2], axis=1)
    return 1 - 0.45 * np.exp(-(away / 0.6) ** 2)


def sprayed(null):
    """The skin gets firmer as it dries; every 420 s it is sprayed, and is at once as soft as it was."""
    return 1 + 0.45 * (1 - np.exp(-((null.t - null.t[0]) % 420) / 200))


def jams(null):
    """Starch in water: moved faster than 4 mm/s its grains jam, and it bears half as much again; at rest it flows."""
    v = np.zeros(len(null.t))
    for rows in presses(null):
        v[rows[1:]] = np.linalg.norm(np.diff(null.u[rows], axis=0), axis=1) / np.diff(null.t[rows])
    return 1 + 0.5 / (1 + np.exp(-(v - 4e-3) / 0.5e-3))


def purrs(null):
    """A cat purrs, at 5.6 Hz as sampled, louder when it breathes in: its skin goes up and down under the tool."""
    loud = 1 + 0.6 * np.sin(2 * np.pi * 0.45 * null.t)
    return nearer(null, 0.5e-3 * loud * np.sin(2 * np.pi * 5.6 * null.t))


def dented(null):
    """Each press leaves a dent as wide as a hand, gone in some minutes: who presses in it meets the skin lower."""
    height, before = np.zeros(len(null.t)), []
    for rows in presses(null):
        for place, t, deep in before:
            away = np.linalg.norm(null.x[rows[0]] - place)
            height[rows] -= 0.28 * deep * np.exp(-away / 25e-3 - (null.t[rows[0]] - t) / 150)
        before.append((null.x[rows[0]], null.t[rows[-1]], depth(null)[rows].max()))
    return nearer(null, height)


def winds_up(null):
    """Going round the body from place to place the arm winds its cable up or off, which pulls by how far it is."""
    out, f, wound = off_middle(null), np.zeros_like(null.f), 0.0
    at = np.arctan2(out[0, 1], out[0, 0])
    for rows in presses(null):
        angle = np.arctan2(out[rows[0], 1], out[rows[0], 0])
        wound += (angle - at + np.pi) % (2 * np.pi) - np.pi
        f[rows], at = wound * np.array([0.01, -0.008, 0.015]), angle
    return f


def over_strained(null):
    """Each load past 0.7 N bends the sensor a little more, for good: after it the zero has gone on by a part."""
    f, zero = np.zeros_like(null.f), np.zeros(3)
    for rows in presses(null):
        f[rows] = zero
        load = np.linalg.norm(null.f[rows], axis=1)
        over = max(0.0, load.max() - 0.7)
        zero = zero + 0.04 * over * null.f[rows[np.argmax(load)]] / load.max()
    return f


def skins_over(null):
    """In the air the gel gets a skin, tougher by and by; it bears its part as soon as it is bent, no more deeper."""
    bears = 0.3 * share(null) * (1 - np.exp(-depth(null) / 1e-3))
    return -bears[:, None] * ways(null)


def alternates(null):
    """Two amplifiers take turns, one stores while the other measures; the second reads a fifth too much."""
    factor = np.ones(len(null.t))
    for rows in presses(null)[1::2]:
        factor[rows] = 1.2
    return factor


def shaken_up(null):
    """A fast press liquefies the gel, a slow one hardly: the next finds it softer, if it comes within a minute."""
    factor, fast = np.ones(len(null.t)), 0.0
    for rows, pause in pauses(null):
        factor[rows] = 1 - 0.75 * min(fast / 20e-3, 1) * np.exp(-pause / 70)
        fast = fastest(null, rows)
    return factor


def tarnishes(null):
    """The contacts of a plug tarnish, and it crackles more and more along the session."""
    return np.random.default_rng(73).normal(0, 0.1, null.f.shape) * share(null)[:, None] ** 1.5


LABORATORY = [
    ("off-axis", plus(off_axis), "place axes", [], {}),
    ("two-logs", two_logs, "history speed", [], {}),
    ("slow-channel", slow_channel, "axes history speed", [], {}),
    ("imputed", imputed, "event history", [], {}),
    ("afloat", plus(afloat), "frequency", ["sensor-hum"], {}),
    ("table-typo", table_typo, "depth axes", ["sensor-curve"], {}),
]
TOOL = [
    ("end-stop", end_stop, "depth", ["learned-depth"], {}),
    ("speed-limit", speed_limit, "speed history", [], {}),
    ("slips-free", slips_free, "direction event history", ["friction"], {}),
    ("own-weight", plus(own_weight), "offset direction set-up", ["tare"], {}),
    ("aquaplanes", aquaplanes, "direction speed history", [], {}),
    ("stalls", times(stalls), "event order", [], {}),
]
BODY = [
    ("comes-back", times(comes_back), "history speed", [], {"path": back_and_forth}),
    ("vaulted", times(vaulted), "place", ["learned-place", "regions", "inclusion"], {}),
    ("sprayed", times(sprayed), "session event", GAINS, {}),
    ("jams", times(jams), "speed", [], {}),
    ("purrs", purrs, "frequency", ["breathing"], {}),
    ("dented", dented, "order place offset", ["touch", "tare"], {}),
]
TIME = [
    ("winds-up", plus(winds_up), "offset place order session", OFFSETS + ["tare"], {}),
    ("over-strained", plus(over_strained), "offset order session", OFFSETS + ["sensor-drift", "tare"], {}),
    ("skins-over", plus(skins_over), "session depth", [], {}),
    ("alternates", times(alternates), "order session event", [], {}),
    ("shaken-up", times(shaken_up), "order session", [], {}),
    ("tarnishes", plus(tarnishes), "noise session", [], {}),
]


def every_latecomer():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in LABORATORY + TOOL + BODY + TIME for k in SIZES]
