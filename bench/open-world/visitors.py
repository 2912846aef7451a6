"""Causes that no effect of the catalogue covers, of the laboratory, of the tool, of the body and
of time by six each, written down from the catalogue's list and the files here, without the
diagnosis' code; kinds and names as in strangers.py, fixed before anything was diagnosed."""
import numpy as np

from causes import Cause, back_and_forth, presses
from strangers import SIZES, depth, plus, ramp_ends, share, since, sized, speed, times


def normals(null):
    """(n, 3), outward: against that press of the place which is nearest to its stiffest way."""
    n = np.linalg.eigh(-null.K - null.K.transpose(0, 2, 1))[1][:, :, 2]
    n *= np.sign(n[:, 2])[:, None]
    way = -null.u / np.maximum(depth(null), 1e-9)[:, None]
    for place in np.unique(null.x, axis=0):
        there = np.flatnonzero((null.x == place).all(axis=1))
        n[there] = way[there[np.argmax((way[there] * n[there]).sum(axis=1))]]
    return n


def along_surface(v, n):
    """What of v (n, 3) is across the normals."""
    return v - (v * n).sum(axis=1)[:, None] * n


def ranges(null):
    """An amplifier that goes to a coarse range past 0.45 N, axis by axis, of another gain."""
    return null.f * np.where(np.abs(null.f) > 0.45, 1.2, 1.0)


def sags(null):
    """The drive's current pulls down what feeds the bridge; it is back 0.15 s after the stop."""
    moves, factor = np.abs(speed(null)) > 1e-9, np.ones(len(null.t))
    for rows in presses(null):
        load = 0.0
        for a, b in zip(rows[:-1], rows[1:]):
            load += (moves[b] - load) * (1 - np.exp(-(null.t[b] - null.t[a]) / 0.15))
            factor[b] = 1 - 0.2 * load
    return factor


def zero_tracks(null):
    """Firmware of a scale: what an axis reads below 0.2 N is taken for its zero within 1.5 s."""
    f = null.f.copy()
    for rows in presses(null):
        zero = np.zeros(3)
        for a, b in zip(rows[:-1], rows[1:]):
            reads = null.f[b] - zero
            step = reads * (1 - np.exp(-(null.t[b] - null.t[a]) / 1.5))
            zero = zero + np.where(np.abs(reads) < 0.2, step, 0)
            f[b] = null.f[b] - zero
    return f


def backs_off(null):
    """A robot that is safe among people: past its limit of force it draws back by 1 mm."""
    u, load = null.u.copy(), np.linalg.norm(null.f, axis=1)
    for rows in presses(null):
        past = np.flatnonzero(load[rows] > 0.6 * load.max())
        if len(past):
            on = rows[past[0]:]
            gone = 1e-3 * (1 - np.exp(-(null.t[on] - null.t[on[0]]) / 0.4))
            u[on] *= (1 - gone / depth(null)[on])[:, None]
    return null.forces(u)


def popcorn(null):
    """A flaw in one axis' amplifier: its zero jumps between two levels, each for 0.8 s or so."""
    random, f = np.random.default_rng(31), np.zeros_like(null.f)
    for rows in presses(null):
        level = random.choice([-0.05, 0.05])
        for a, b in zip(rows[:-1], rows[1:]):
            f[a, 1] = level
            if random.random() > np.exp(-(null.t[b] - null.t[a]) / 0.8):
                level = -level
        f[rows[-1], 1] = level
    return f


def aliases(null):
    """Mains of 50 Hz, sampled at a whole part of it: what is left is how far the grid is off."""
    random, off = np.random.default_rng(32), [0.03]
    seconds = np.arange(int(null.t[-1] - null.t[0]) + 2)
    for _ in seconds[1:]:
        off.append(off[-1] * np.exp(-1 / 120) + random.normal(0, 0.03 * np.sqrt(2 / 120)))
    phase = 2 * np.pi * np.cumsum(off)
    return np.outer(np.sin(np.interp(null.t - null.t[0], seconds, phase)), (0.02, 0.03, 0.06))


def wears(null):
    """The tool's rim wears round by the work it does: its first 1.5 mm carry less."""
    d, work = np.maximum(depth(null), 1e-9), np.zeros(len(null.t))
    load, done = np.linalg.norm(null.f, axis=1), 0.0
    for rows in presses(null):
        work[rows] = done
        done += (load[rows[1:]] * np.abs(np.diff(depth(null)[rows]))).sum()
    return 1 - 0.5 * work / done * 1.5e-3 * (1 - np.exp(-d / 1.5e-3)) / d


def wiped(null):
    """Slime makes a cushion on the tool, thicker by each press; it is wiped after six."""
    factor = np.ones(len(null.t))
    for k, rows in enumerate(presses(null)):
        factor[rows] = 1 / (1 + 0.05 * (k % 6))
    return factor


def hair(null):
    """One half of the body is hairy: hairs stand against the tool, and lie down as it goes on."""
    d, way = depth(null), null.u / np.maximum(depth(null), 1e-9)[:, None]
    hairy = null.x[:, 1] > np.median(np.unique(null.x, axis=0)[:, 1])
    stand = hairy * d / 1.5e-3 * np.exp(1 - d / 1.5e-3)
    return -0.1 * stand[:, None] * way


def static(null):
    """Rubbed sideways a rubber tool is charged, the sensor's zero with it; lost within 150 s."""
    f, held, last = np.zeros_like(null.f), 0.0, 0
    side = along_surface(null.u, normals(null))
    for rows in presses(null):
        for row in rows:
            held *= np.exp(-(null.t[row] - null.t[last]) / 150)
            if row != rows[0]:
                held += np.linalg.norm(side[row] - side[last])
            f[row], last = held * np.array([-8.0, 5.0, 20.0]), row
    return f


def seats(null):
    """The tool's flat face is askew: one edge comes first, and pushes aside, until all is down."""
    d = np.maximum(depth(null), 1e-9)
    edge = 0.8e-3 * (1 - np.exp(-d / 0.8e-3))
    return null.f * (1 - 0.4 * edge / d)[:, None] + np.outer(edge, (60, 0, 0))


def bows(null):
    """A slender tool buckles from half of the largest load on, always to the same side."""
    n = normals(null)
    load = np.abs((null.f * n).sum(axis=1))
    limit = load.max() / 2
    over = np.maximum(0, load - limit)
    bow = along_surface(np.tile((1.0, 0, 0), (len(n), 1)), n)
    return null.f - 0.3 * over[:, None] * n + 0.15 * np.sqrt(limit * over)[:, None] * bow


def ridges(null):
    """A skin of ridges lets the tool slip along them, and holds it across."""
    n = normals(null)
    along = along_surface(np.tile((np.cos(0.6), np.sin(0.6), 0), (len(n), 1)), n)
    along /= np.linalg.norm(along, axis=1)[:, None]
    s, limit = (null.f * along).sum(axis=1), 0.05 * np.abs((null.f * n).sum(axis=1))
    over = np.sign(s) * np.maximum(0, np.abs(s) - limit)
    return null.f - 0.8 * over[:, None] * along


def spastic(null):
    """Stretched faster than 6 mm/s a muscle catches 0.1 s later, and lets go within a second."""
    factor = np.ones(len(null.t))
    for rows in presses(null):
        fast = min(1.0, max(0.0, np.abs(speed(null)[rows]).max() / 6e-3 - 1))
        s = since(null)[rows] - 0.1
        factor[rows] = 1 + 0.3 * fast * (s > 0) * np.exp(-np.maximum(s, 0) / 0.9)
    return factor


def pits(null):
    """Oedema: liquid gives way under the tool within 1.2 s, and is back at the place in 150 s."""
    d, factor, pit, left = depth(null), np.ones(len(null.t)), {}, {}
    for rows in presses(null):
        key = tuple(null.x[rows[0]])
        deep = pit.get(key, 0.0) * np.exp(-(null.t[rows[0]] - left.get(key, 0.0)) / 150)
        for a, b in zip(rows[:-1], rows[1:]):
            aim, tau = (0.4 * d[b], 1.2) if 0.4 * d[b] > deep else (0.0, 150)
            deep = aim + (deep - aim) * np.exp(-(null.t[b] - null.t[a]) / tau)
            factor[b] = max(0.0, 1 - deep / max(d[b], 1e-9))
        pit[key], left[key] = deep, null.t[rows[-1]]
    return factor


def snaps(null):
    """A shell snaps in at 2.8 mm, like a lid, and out again at 2.2 mm; deeper it lies on."""
    d, factor = depth(null), np.ones(len(null.t))
    for rows in presses(null):
        inside = False
        for row in rows:
            inside = d[row] > (2.2e-3 if inside else 2.8e-3)
            if inside:
                factor[row] = 1 - 0.4 * np.exp(-(d[row] - 2.2e-3) / 2e-3)
    return factor


def sheet(null):
    """Skin slides on what is below, as one sheet, and stays; who presses it next is pulled back."""
    n, f, slid = normals(null), np.zeros_like(null.f), np.zeros(3)
    side = along_surface(null.u, n)
    for rows in presses(null):
        grip = 1 - np.exp(-depth(null)[rows] / 2e-3)
        f[rows] = -60 * grip[:, None] * along_surface(np.tile(slid, (len(rows), 1)), n[rows])
        slid = 0.8 * slid + 0.6 * side[rows[-1]]
    return f


def peristalsis(null):
    """A wave runs through the gut once in 5.5 s: each place rises in its turn."""
    phase = 2 * np.pi * ((null.t - null.t[0]) / 5.5 - null.x[:, 1] / 0.07)
    return null.forces(null.u - np.outer(np.sin(phase), (0, 0, 0.3e-3)))


def scars(null):
    """A place that was pressed past 3 mm heals within some 250 s, and harder than it was."""
    factor, hurts = np.ones(len(null.t)), {}
    for rows in presses(null):
        of_place = hurts.setdefault(tuple(null.x[rows[0]]), [])
        healed = sum(h * (1 - np.exp(-(null.t[rows[0]] - t) / 250)) for h, t in of_place)
        factor[rows] = 1 + 0.2 * np.tanh(healed)
        of_place.append((max(0.0, depth(null)[rows].max() / 3e-3 - 1), null.t[rows[-1]]))
    return factor


def ages(null):
    """A gel that sets: it relaxes within a quarter of a second at first, within 4 s at the end."""
    f, every_tau = null.f.copy(), 0.25 * 16 ** share(null)
    for rows in presses(null):
        held, tau = np.zeros(3), every_tau[rows[0]]
        for a, b in zip(rows[:-1], rows[1:]):
            part = (null.t[b] - null.t[a]) / tau
            held = held * np.exp(-part)
            held = held + (null.f[b] - null.f[a]) * (1 - np.exp(-part)) / part
            f[b] += 0.4 * held
    return f


def two_hands(null):
    """Two people hold the tool in turns of four presses, and one holds it askew by 7 deg."""
    c, s = np.cos(np.radians(7)), np.sin(np.radians(7))
    f, turn = null.f.copy(), np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    for k, rows in enumerate(presses(null)):
        if k // 4 % 2:
            f[rows] = null.f[rows] @ turn.T
    return f


def found_late(null):
    """The surface is said to be where the tool is 25 ms after it touched: too deep, by speed."""
    u = null.u.copy()
    for rows in presses(null):
        into = (null.u[rows[1]] - null.u[rows[0]]) / (null.t[rows[1]] - null.t[rows[0]])
        u[rows] += 25e-3 * into
    return null.forces(u)


def hunts(null):
    """A drive with friction cannot stand still: once stopped it goes to and fro, unseen."""
    u = null.u.copy()
    for rows, end in zip(presses(null), ramp_ends(null)):
        after = rows[rows >= end]
        s = null.t[after] - null.t[end]
        wave = 2 / np.pi * np.arcsin(np.sin(2 * np.pi * 0.9 * s)) * (1 - np.exp(-s / 0.5))
        u[after] *= (1 + 0.2e-3 * wave / depth(null)[after])[:, None]
    return null.forces(u)


def stale(null):
    """A buffer is not emptied: a press's first 0.2 s are the last ones of the press before."""
    f, every = null.f.copy(), presses(null)
    for before, rows in zip(every[:-1], every[1:]):
        n = int((since(null)[rows] < 0.2).sum())
        f[rows[:n]] = null.f[before[-n:]]
    return f


LABORATORY = [
    ("ranges", ranges, "depth axes", ["sensor-curve"], {}),
    ("sags", times(sags), "speed history", [], {}),
    ("zero-tracks", zero_tracks, "history depth offset axes", ["tare", "deadband"], {}),
    ("backs-off", backs_off, "depth history event", [], {}),
    ("popcorn", plus(popcorn), "noise event offset axes", [], {}),
    ("aliases", plus(aliases), "offset session frequency", ["tare", "sensor-hum"], {}),
]
TOOL = [
    ("wears", times(wears), "session order depth", ["tip"], {}),
    ("wiped", times(wiped), "session order event", [], {}),
    ("hair", plus(hair), "place depth", [], {}),
    ("static", plus(static), "offset order session direction", ["tare"], {}),
    ("seats", seats, "depth axes direction set-up", ["tip"], {}),
    ("bows", bows, "depth axes direction", ["arm-compliance"], {}),
]
BODY = [
    ("ridges", ridges, "direction axes", ["friction"], {}),
    ("spastic", times(spastic), "speed history", [], {}),
    ("pits", times(pits), "history order", ["poroelastic", "viscoelastic", "plastic"], {}),
    ("snaps", times(snaps), "depth history event", [], {"path": back_and_forth}),
    ("sheet", plus(sheet), "direction axes order", [], {}),
    ("peristalsis", peristalsis, "frequency place", ["breathing"], {}),
]
TIME = [
    ("scars", times(scars), "order place session", [], {}),
    ("ages", ages, "history session", ["viscoelastic"], {}),
    ("two-hands", two_hands, "session order event axes set-up", ["sensor-rotation"], {}),
    ("found-late", found_late, "speed offset", ["touch", "tare"], {}),
    ("hunts", hunts, "frequency history speed", [], {}),
    ("stale", stale, "order history event", [], {}),
]


def every_visitor():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in LABORATORY + TOOL + BODY + TIME for k in SIZES]
