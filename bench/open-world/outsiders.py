"""Causes that no effect of the catalogue covers, of the laboratory as much as of the body, written down after those of
newcomers.py; kinds and names as in strangers.py, fixed before anything was diagnosed."""
import numpy as np

from causes import Cause, back_and_forth, presses
from strangers import OFFSETS, RELAX, SIZES, depth, plus, share, shifted, since, sized, speed, times


def glove(null):
    """A glove, worn for the middle third of the presses, has to be pressed flat first."""
    d, factor = np.maximum(depth(null), 1e-9), np.ones(len(null.t))
    every = presses(null)
    for rows in every[len(every) // 3:2 * len(every) // 3]:
        factor[rows] = 1 - 0.4e-3 * (1 - np.exp(-d[rows] / 0.4e-3)) / d[rows]
    return factor


def resent(null):
    """Of packets of four samples one in three comes after the next, and is filed as it came."""
    random, f = np.random.default_rng(21), null.f.copy()
    for rows in presses(null):
        at = 0
        while at + 8 <= len(rows):
            if random.random() < 1 / 3:
                f[rows[at:at + 4]], f[rows[at + 4:at + 8]] = null.f[rows[at + 4:at + 8]], null.f[rows[at:at + 4]]
                at += 4
            at += 4
    return f


def whines(null):
    """While the drive runs its current is picked up by the cable of one axis."""
    return np.outer(np.sin(2 * np.pi * 6.7 * null.t) * (np.abs(speed(null)) > 1e-9), (0, 0.05, 0))


def chatters(null):
    """While the tool moves its guide rattles, by chance."""
    moves = np.abs(speed(null)) > 1e-9
    return np.random.default_rng(22).normal(0, 0.04, null.f.shape) * moves[:, None]


def table_tips(null):
    """The table rocks about its middle line, by the load's moment."""
    lever = np.stack([np.zeros(len(null.t)), -null.x[:, 2], null.x[:, 1] - null.x[:, 1].mean()], axis=1)
    angle = 0.05 * (lever * null.f).sum(axis=1)
    return null.forces(null.u + angle[:, None] * lever)


def clamp_turns(null):
    """After each large load the sensor has turned a little in its clamp."""
    f, angle, limit = null.f.copy(), 0.0, 0.85 * np.linalg.norm(null.f, axis=1).max()
    for rows in presses(null):
        c, s = np.cos(angle), np.sin(angle)
        f[rows] = null.f[rows] @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
        angle += np.radians(2) * (np.linalg.norm(null.f[rows], axis=1).max() > limit)
    return f


def thins(null):
    """A structure that motion breaks and rest builds up again, within a second (thixotropy)."""
    factor = np.ones(len(null.t))
    for rows in presses(null):
        whole = 1.0
        for a, b in zip(rows[:-1], rows[1:]):
            whole += (1 - whole) * (1 - np.exp(-(null.t[b] - null.t[a]) / 1.0))
            whole *= np.exp(-np.linalg.norm(null.u[b] - null.u[a]) / 3e-3)
            factor[b] = 0.7 + 0.3 * whole
    return factor


def axes_late(null):
    """Filters of different order: x comes 0.09 s late, y 0.04 s, z in time."""
    f = null.f.copy()
    for k, delay in ((0, 0.09), (1, 0.04)):
        f[:, k] = shifted(null, np.full(len(null.t), -delay))[:, k]
    return f


def plugged_round(null):
    """One axis' plug is put in the other way round at half time."""
    f = null.f.copy()
    f[share(null) > 0.5, 1] *= -1
    return f


def slews(null):
    """An amplifier that follows by 1.5 N/s at most."""
    f = null.f.copy()
    for rows in presses(null):
        for a, b in zip(rows[:-1], rows[1:]):
            most = 1.5 * (null.t[b] - null.t[a])
            f[b] = f[a] + np.clip(null.f[b] - f[a], -most, most)
    return f


def leaks(null):
    """A piezo's charge leaks within 40 s, and what has leaked is missing when the load is gone."""
    f, gone, last = null.f.copy(), np.zeros(3), null.t[0]
    for rows in presses(null):
        for row in rows:
            load = null.f[row] if row != rows[0] else 0.0
            gone = load + (gone - load) * np.exp(-(null.t[row] - last) / 40)
            f[row], last = null.f[row] - gone, null.t[row]
    return f


def edges_dry(null):
    """The body dries from its edges in, and hardens there."""
    out = np.linalg.norm(null.x[:, :2] - null.x[:, :2].mean(axis=0), axis=1)
    return 1 + 0.3 * (out / out.max()) ** 2 * share(null)


def swells(null):
    """The body takes up water and its top rises, so the tool is deeper than it is said to be."""
    return null.forces(null.u - np.outer(0.3e-3 * np.sqrt(share(null)), (0, 0, 1)))


def bubble(null):
    """A bubble under the skin takes up the first 1.5 mm; pressed, it goes to the nearest other place."""
    places, d, factor = np.unique(null.x, axis=0), np.maximum(depth(null), 1e-9), np.ones(len(null.t))
    lies = 0
    for rows in presses(null):
        if (places[lies] == null.x[rows[0]]).all():
            factor[rows] = 1 - 0.6 * np.minimum(d[rows], 1.5e-3) / d[rows]
            away = np.linalg.norm(places - places[lies], axis=1)
            away[lies] = np.inf
            lies = int(np.argmin(away))
    return factor


def play_sideways(null):
    """A gear loses 0.3 mm sideways where it has to turn back from the way it last went, be it between the presses."""
    u, went, at = null.u.copy(), np.zeros(3), null.x[0]
    for rows in presses(null):
        travel = null.x[rows[0]] - at
        went = np.where(np.abs(travel) > 1e-6, np.sign(travel), went)
        side = null.u[rows[-1]]
        for k in (0, 1):
            if side[k] * went[k] < 0:
                u[rows, k] = np.sign(side[k]) * np.maximum(0, np.abs(null.u[rows, k]) - 0.3e-3)
        went, at = np.where(np.abs(side) > 1e-6, -np.sign(side), went), null.x[rows[0]]
    return null.forces(u)


def overloads(null):
    """An amplifier that was driven past 0.7 N is off from then on, and recovers within a second."""
    f = np.zeros_like(null.f)
    for rows in presses(null):
        past = np.flatnonzero(np.linalg.norm(null.f[rows], axis=1) > 0.7)
        if len(past):
            on = rows[past[0]:]
            f[on] = np.outer(np.exp(-(null.t[on] - null.t[on[0]]) / 1.0), (0.01, 0.02, -0.1))
    return f


def screw(null):
    """The drive's screw is bent: what it moves swings about what is recorded, once a turn of 1.7 mm."""
    u = null.u.copy()
    u[:, 2] += 0.1e-3 * np.sin(2 * np.pi * null.u[:, 2] / 1.7e-3)
    return null.forces(u)


def spins_down(null):
    """A centrifuge on the bench slows down from 6 to 2 Hz."""
    s = share(null)
    phase = 2 * np.pi * (null.t[-1] - null.t[0]) * (6 * s - 2 * s ** 2)
    return np.outer(np.sin(phase), (0.03, 0.01, 0.03)) + np.outer(np.cos(phase), (0, 0.03, 0.01))


def warm_body(null):
    """A warm body heats the sensor as long as it is touched, however hard, and its zero goes along; cools in 80 s."""
    f, warm, last = np.zeros_like(null.f), 0.0, null.t[0]
    for rows in presses(null):
        warm *= np.exp(-(null.t[rows[0]] - last) / 80)
        now = 1 + (warm - 1) * np.exp(-since(null)[rows] / 6)
        f[rows] = np.outer(now, (0.02, -0.03, 0.08))
        warm, last = now[-1], null.t[rows[-1]]
    return f


def digs(null):
    """Moved sideways, whichever way, the tool's rim ploughs and is pushed up."""
    return np.outer(np.linalg.norm(null.u[:, :2], axis=1), (0, 0, 40))


def film(null):
    """Gel on the skin has to be squeezed out: a drag that falls with the third power of what is left of the film."""
    into = np.maximum(0, -speed(null))
    return np.outer(into / (1 + depth(null) / 0.5e-3) ** 3, (0, 0, 30))


def fat_patch(null):
    """Only one half of the body relaxes."""
    soft = null.x[:, 1] > np.median(np.unique(null.x, axis=0)[:, 1])
    return np.where(soft[:, None], RELAX(null), null.f)


def hiccups(null):
    """Every 2.9 s the body jerks up, for a fifth of a second."""
    s = (null.t - null.t[0] + 1.2) % 2.9
    return null.forces(null.u - np.outer(np.exp(-((s - 1.5) / 0.1) ** 2), (0, 0, 0.3e-3)))


def loses_steps(null):
    """A stepper that drops one step in eight where it is driven faster than 9 mm/s; the counted steps are recorded."""
    u = null.u.copy()
    for rows in presses(null):
        if np.abs(speed(null)[rows]).max() > 9e-3:
            u[rows] *= 7 / 8
    return null.forces(u)


PLAIN = [
    ("glove", times(glove), "session order event depth", [], {}),
    ("resent", resent, "event history speed", [], {}),
    ("whines", plus(whines), "frequency speed axes", [], {}),
    ("chatters", plus(chatters), "noise speed", [], {}),
    ("table-tips", table_tips, "place set-up", [], {}),
    ("clamp-turns", clamp_turns, "session order event axes set-up", ["sensor-rotation"], {}),
    ("thins", times(thins), "history speed", [], {"path": back_and_forth}),
    ("axes-late", axes_late, "history speed axes", [], {}),
    ("plugged-round", plugged_round, "session order event axes", [], {}),
    ("slews", slews, "speed history", [], {}),
    ("leaks", leaks, "history session offset", ["viscoelastic"], {}),
    ("edges-dry", times(edges_dry), "place session", [], {}),
    ("swells", swells, "session offset", OFFSETS + ["tare"], {}),
    ("bubble", times(bubble), "place order depth event", [], {}),
    ("play-sideways", play_sideways, "direction axes order", [], {}),
    ("overloads", plus(overloads), "depth history event", [], {"path": back_and_forth}),
    ("screw", screw, "depth", [], {}),
    ("spins-down", plus(spins_down), "frequency session", [], {}),
    ("warm-body", plus(warm_body), "offset history session", [], {}),
    ("digs", plus(digs), "direction axes", [], {}),
    ("film", plus(film), "speed depth history", ["damper"], {}),
    ("fat-patch", fat_patch, "place history", ["viscoelastic"], {}),
    ("hiccups", hiccups, "frequency event", ["breathing"], {}),
    ("loses-steps", loses_steps, "speed", [], {}),
]


def every_outsider():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in PLAIN for k in SIZES]
