"""Causes that no effect of the catalogue covers, of the laboratory, of the tool, of the body and
of time by six each, written down from the catalogue's list and the files of the causes before
them alone; kinds and names as in strangers.py, fixed before anything was diagnosed."""
import copy

import numpy as np

from callers import nearer, ways
from causes import Cause, back_and_forth, presses
from guests import pauses
from strangers import GAINS, OFFSETS, SIZES, depth, plus, share, shifted, since, sized, times
from visitors import along_surface, normals


def off_middle(null):
    """(n, 3), of each place, -1 to 1 from side to side of all places."""
    places = np.unique(null.x, axis=0)
    half = np.maximum(np.ptp(places, axis=0) / 2, 1e-9)
    return (null.x - (places.max(axis=0) + places.min(axis=0)) / 2) / half


def fastest(null, rows):
    """Of a press [m/s]."""
    return (np.linalg.norm(np.diff(null.u[rows], axis=0), axis=1) / np.diff(null.t[rows])).max()


def idle_tone(null):
    """A converter of one bit sings by itself, axis by axis, at 7 Hz for each newton that it reads."""
    f = np.zeros_like(null.f)
    for rows in presses(null):
        dt = np.diff(null.t[rows], prepend=null.t[rows[0]])
        f[rows] = 0.05 * np.sin(2 * np.pi * 7 * np.cumsum(np.abs(null.f[rows]) * dt[:, None], axis=0))
    return f


def tapered(null):
    """A script for spectra fades each press in and out, over an eighth of it at both ends, before it is stored."""
    factor = np.ones(len(null.t))
    for rows in presses(null):
        s = since(null)[rows] / since(null)[rows[-1]]
        factor[rows] = 0.5 - 0.5 * np.cos(np.pi * np.minimum(np.minimum(s, 1 - s) * 8, 1))
    return factor


def sends_changes(null):
    """To save its battery a radio sends an axis only when 0.12 N off what it sent last; till then that stays."""
    f = null.f.copy()
    for rows in presses(null):
        sent = null.f[rows[0]].copy()
        for row in rows:
            sent = np.where(np.abs(null.f[row] - sent) > 0.12, null.f[row], sent)
            f[row] = sent
    return f


def unsigned(null):
    """The meters of both axes across are left on absolute: they show how large a force is, not which way."""
    return np.column_stack([np.abs(null.f[:, :2]), null.f[:, 2]])


def sticky_cell(null):
    """Of the four cells under the body one sticks: the first 0.15 N of its part, most at its corner, are not shown."""
    a, b = (off_middle(null)[:, 0] + 1) / 2, (off_middle(null)[:, 1] + 1) / 2
    f = null.f.copy()
    f[:, 2] -= np.sign(f[:, 2]) * np.minimum(a * b * np.abs(f[:, 2]), 0.15)
    return f


def brownouts(null):
    """A furnace next door is on for a minute or two, off for some more: the mains and what feeds the bridge go down."""
    random, factor, at = np.random.default_rng(61), np.ones(len(null.t)), null.t[0]
    while at < null.t[-1]:
        on = at + random.uniform(60, 180)
        off = on + random.uniform(50, 140)
        factor[(null.t >= on) & (null.t < off)] = 0.85
        at = off
    return factor


def breaks_away(null):
    """A pneumatic slide sticks, more the longer it stood: the first 1 to 3 mm are not made, then it leaps after."""
    factor = np.ones(len(null.t))
    for rows, pause in pauses(null):
        stuck = min(3e-3 - 2e-3 * np.exp(-pause / 60), 0.8 * depth(null)[rows].max())
        factor[rows] = depth(null)[rows] > stuck
    return factor


def eases(null):
    """The way in is recorded as the straight line that was ordered; the robot starts and ends it softly."""
    u = null.u.copy()
    for rows in presses(null):
        s = np.minimum(depth(null)[rows] / depth(null)[rows].max(), 1)
        u[rows] = null.u[rows[-1]] * (s ** 3 * (10 - 15 * s + 6 * s * s))[:, None]
    return null.forces(u)


def castor(null):
    """The tip is a wheel that swivels to where it was last pushed sideways: along that it rolls, across it holds."""
    n = normals(null)
    side, push = along_surface(null.u, n), along_surface(null.f, n)
    f, wheel = null.f.copy(), np.array([1.0, 0, 0])
    for rows in presses(null):
        f[rows] -= 0.7 * np.outer(push[rows] @ wheel, wheel)
        by = np.linalg.norm(side[rows[-1]])
        if by > 0.3e-3:
            wheel = side[rows[-1]] / by
    return f


def bounces(null):
    """Faster than 3 mm/s the tool bounces off the skin: in the air from 0.05 to 0.19 s after touching, and again."""
    factor = np.ones(len(null.t))
    for rows in presses(null):
        s = since(null)[rows]
        air = ((s > 0.05) & (s < 0.19)) | ((s > 0.25) & (s < 0.33))
        factor[rows] -= np.clip(fastest(null, rows) / 3e-3 - 1, 0, 1) * air
    return factor


def swings(null):
    """The arm swings about its foot by 25 deg either way: pushes go in its axes, and are recorded in the table's."""
    angle = np.radians(25) * off_middle(null)[:, 0]
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = null.u.T
    return null.forces(np.stack([c * x - s * y, s * x + c * y, z], axis=1))


def two_tools(null):
    """What is to go deeper than 4 mm is pressed with the sturdy tool, that is wider than the one which is declared."""
    factor = np.ones(len(null.t))
    for rows in presses(null):
        factor[rows] += 0.15 * (depth(null)[rows].max() > 4e-3)
    return factor


def rolls(null):
    """A roundish body rolls a little to the side where it is pressed, and stays so: that side lies lower henceforth."""
    load, lever = np.linalg.norm(null.f, axis=1), off_middle(null)[:, 0]
    height, angle = np.zeros(len(null.t)), 0.0
    for rows in presses(null):
        height[rows] = -0.6e-3 * angle * lever[rows]
        angle = 0.7 * angle + lever[rows[0]] * load[rows].max() / load.max()
    return nearer(null, height)


def thin_side(null):
    """The body is a wedge on a hard table, which is felt from 1.5 mm on at its thin side, from 5.5 mm at the other."""
    from_there = 3.5e-3 + 2e-3 * off_middle(null)[:, 0]
    return -120 * np.maximum(0, depth(null) - from_there)[:, None] * ways(null)


def comes_round(null):
    """Narcosis wears off: breath is slow and shallow at first, 0.2 Hz, three times as fast and deep at the end."""
    s = share(null)
    phase = 2 * np.pi * (null.t[-1] - null.t[0]) * (0.2 * s + 0.2 * s ** 2)
    return null.forces(null.u - np.outer((0.15 + 0.3 * s) * 1e-3 * np.sin(phase), (0, 0, 1)))


def packs(null):
    """A bag of grains: straight presses pack it firmer by and by, one sideways stirs it loose again."""
    n, factor, packed = normals(null), np.ones(len(null.t)), 0.0
    side = np.linalg.norm(along_surface(null.u, n), axis=1)
    for rows in presses(null):
        factor[rows] = 1 + 0.3 * packed
        stirred = side[rows[-1]] > 0.3 * depth(null)[rows[-1]]
        packed = 0.1 * packed if stirred else packed + 0.3 * (1 - packed)
    return factor


def whorls(null):
    """Fibres in the skin run another way at each place, as in a whorl: along them it holds more, across them less."""
    n, angle = normals(null), 2.5 * off_middle(null)[:, 1] + 0.5
    fibre = along_surface(np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1), n)
    fibre /= np.linalg.norm(fibre, axis=1)[:, None]
    side = along_surface(null.u, n)
    return -60 * (2 * (side * fibre).sum(axis=1)[:, None] * fibre - side)


def collapses(null):
    """A weak gel bears a load for some seconds, fewer if it is large, then gives way at once; it mends in the pause."""
    load, factor = np.linalg.norm(null.f, axis=1), np.ones(len(null.t))
    for rows in presses(null):
        dt = np.diff(null.t[rows], prepend=null.t[rows[0]])
        broken = np.cumsum(dt * np.exp((load[rows] - 1) / 0.35)) > 1
        if broken.any():
            s = null.t[rows] - null.t[rows[np.argmax(broken)]]
            factor[rows] = 1 - 0.3 * broken * (1 - np.exp(-np.maximum(s, 0) / 0.08))
    return factor


def copied(null):
    """When a file could not be written, in one press of five, the script took the forces of the one before again."""
    f, every = null.f.copy(), presses(null)
    for before, rows in list(zip(every[:-1], every[1:]))[3::5]:
        for k in range(3):
            f[rows, k] = np.interp(since(null)[rows], since(null)[before], null.f[before, k])
    return f


def comes_from(null):
    """The gantry leans the way it drove last: a place that it comes to from -x is met 0.3 mm lower, from +x higher."""
    height, at, lean = np.zeros(len(null.t)), null.x[0, 0], 0.0
    for rows in presses(null):
        travel = null.x[rows[0], 0] - at
        lean = np.sign(travel) if abs(travel) > 1e-6 else lean
        height[rows], at = -0.3e-3 * lean, null.x[rows[0], 0]
    return nearer(null, height)


def triggered(null):
    """The meter's record starts at its trigger of 0.1 N, and is filed as if that had been when the way in began."""
    load, offsets = np.linalg.norm(null.f, axis=1), np.zeros(len(null.t))
    for rows in presses(null):
        past = np.flatnonzero(load[rows] > 0.1)
        if len(past):
            b = max(past[0], 1)
            offsets[rows] = np.interp(0.1, load[rows[b - 1:b + 1]], since(null)[rows[b - 1:b + 1]])
    return shifted(null, offsets)


def retares(null):
    """The zero creeps away by 0.1 N in 270 s; who sees more than that on the display before a press tares it."""
    zero, tared = np.zeros(len(null.t)), null.t[0]
    for rows in presses(null):
        if null.t[rows[0]] - tared > 270:
            tared = null.t[rows[0]]
        zero[rows] = (null.t[rows] - tared) / 270
    return np.outer(zero, (0.04, -0.03, 0.1))


def doors(null):
    """A door slams in one press of three: table and body quiver at 3.4 Hz for a second or so, whatever is pressed."""
    random, f = np.random.default_rng(62), np.zeros_like(null.f)
    for rows in presses(null)[1::3]:
        s = since(null)[rows] - random.uniform(0.2, 1.6)
        quiver = np.exp(-np.maximum(s, 0) / 0.7) * np.sin(2 * np.pi * 3.4 * s) * (s > 0)
        f[rows] = np.outer(quiver, (0.2, -0.25, 0.1))
    return f


def laid_back(null):
    """At 0.6 of the session the body is taken off and laid back 25 mm off along y: other spots are pressed since."""
    places = np.unique(null.x, axis=0)
    every = np.array([null.K[np.argmax((null.x == p).all(axis=1))] for p in places])
    away = np.linalg.norm(null.x[:, None] + (0, 25e-3, 0) - places, axis=2)
    near = away ** -4 / (away ** -4).sum(axis=1)[:, None]
    moved = copy.copy(null)
    moved.K = np.where((share(null) > 0.6)[:, None, None], np.einsum("np,pij->nij", near, every), null.K)
    return moved.forces(null.u)


LABORATORY = [
    ("idle-tone", plus(idle_tone), "frequency depth", [], {}),
    ("tapered", times(tapered), "history", [], {}),
    ("sends-changes", sends_changes, "history depth axes", ["sensor-hysteresis", "deadband"], {"path": back_and_forth}),
    ("unsigned", unsigned, "axes direction", ["sensor-curve"], {}),
    ("sticky-cell", sticky_cell, "place depth", [], {}),
    ("brownouts", times(brownouts), "session event", GAINS, {}),
]
TOOL = [
    ("breaks-away", times(breaks_away), "history event depth", [], {}),
    ("eases", eases, "history speed", [], {}),
    ("castor", castor, "direction order", [], {}),
    ("bounces", times(bounces), "speed history event", [], {}),
    ("swings", swings, "place direction set-up", ["motion-rotation"], {}),
    ("two-tools", times(two_tools), "depth event", [], {}),
]
BODY = [
    ("rolls", rolls, "order place offset", ["touch", "tare"], {}),
    ("thin-side", plus(thin_side), "place depth", [], {}),
    ("comes-round", comes_round, "frequency session", ["breathing"], {}),
    ("packs", times(packs), "order session", [], {}),
    ("whorls", plus(whorls), "place direction", ["anisotropic"], {}),
    ("collapses", times(collapses), "history depth event", [], {}),
]
TIME = [
    ("copied", copied, "event order", [], {}),
    ("comes-from", comes_from, "order offset", ["touch", "tare"], {}),
    ("triggered", triggered, "history speed", ["clock"], {}),
    ("re-tares", plus(retares), "session offset event", OFFSETS + ["tare"], {}),
    ("doors", plus(doors), "event frequency", [], {}),
    ("laid-back", laid_back, "session place event", ["shift"], {}),
]


def every_drifter():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in LABORATORY + TOOL + BODY + TIME for k in SIZES]
