"""Causes that no effect of the catalogue covers, of the laboratory, of the tool, of the body and
of time by six each, written down from the catalogue's list and the files of the causes before
them alone; kinds and names as in strangers.py, fixed before anything was diagnosed."""
import numpy as np

from callers import ways
from causes import Cause, back_and_forth, presses
from guests import pauses
from strangers import RELAX, SIZES, depth, plus, share, since, sized, times
from visitors import along_surface, normals


def longer(null, length):
    """The forces of a tool that reaches further by length (n) [m] than it is said to, or less far."""
    way, d = ways(null), depth(null)
    return null.forces(null.u + way * (np.maximum(0, d + length) - d)[:, None])


def peak_hold(null):
    """The meter is left on peak: an axis shows the largest of late, which fades within 1.5 s."""
    f = null.f.copy()
    for rows in presses(null):
        for a, b in zip(rows[:-1], rows[1:]):
            held = f[a] * np.exp(-(null.t[b] - null.t[a]) / 1.5)
            f[b] = np.where(np.abs(held) > np.abs(null.f[b]), held, null.f[b])
    return f


def lost_nought(null):
    """A gauge sends ounces and hundredths as two numbers, put together without a nought: 1.05 is read as 1.5."""
    ounce = 0.278
    hundredths = np.round(np.abs(null.f) / ounce * 100)
    whole, rest = hundredths // 100, hundredths % 100
    return np.sign(null.f) * ounce * (whole + np.where(rest < 10, rest / 10, rest / 100))


def tares_late(null):
    """Each press is tared by its first three samples, when the tool is under way already."""
    f = null.f.copy()
    for rows in presses(null):
        f[rows] -= null.f[rows[:3]].mean(axis=0)
    return f


def light_leak(null):
    """An optical sensor sees the room's light past the tool, until the tool is deep in and it is dark."""
    return np.outer(np.exp(-depth(null) / 1.5e-3), (0.08, -0.06, 0.2))


def notched(null):
    """Against a hum of 2.5 Hz software cuts out a band, of what is pressed as well."""
    f = null.f.copy()
    for rows in presses(null):
        w = 2 * np.pi * 2.5 * (null.t[rows[1]] - null.t[rows[0]])
        c, a = np.cos(w), np.sin(w) / 2
        for i, row in enumerate(rows):
            one, two = rows[max(i - 1, 0)], rows[max(i - 2, 0)]
            if i:
                f[row] = (null.f[row] - 2 * c * null.f[one] + null.f[two] + 2 * c * f[one] - (1 - a) * f[two]) / (1 + a)
    return f


def cracked_wire(null):
    """A lead of the axis along z is cracked: while the arm leans to +x by 0.4 mm half the bridge is off."""
    f = null.f.copy()
    f[:, 2] *= np.where(null.u[:, 0] > 0.4e-3, 0.75, 1)
    return f


def spins(null):
    """The tool turns on its axis: pushed sideways its front edge presses most, and walks off across."""
    n = normals(null)
    side, load = along_surface(null.u, n), np.abs((null.f * n).sum(axis=1))
    by = np.linalg.norm(side, axis=1)
    return 0.25 * (load / (by + 0.5e-3))[:, None] * np.cross(n, side)


def edge_first(null):
    """The tool goes in along its axis: askew to the surface, its edge comes first, until all the face is down."""
    d = np.maximum(depth(null), 1e-9)
    askew = np.maximum(4e-3 * np.linalg.norm(along_surface(ways(null), normals(null)), axis=1), 1e-6)
    return 1 - 0.6 * askew * (1 - np.exp(-d / askew)) / d


def crumb(null):
    """Two places are gritty: a crumb sticks to the tool there, and is wiped off by the next push sideways."""
    d, side, f = depth(null), np.linalg.norm(along_surface(null.u, normals(null)), axis=1), np.zeros_like(null.f)
    gritty, sticks = {tuple(p) for p in np.unique(null.x, axis=0)[[1, 3]]}, False
    for rows in presses(null):
        sticks = sticks or tuple(null.x[rows[0]]) in gritty
        on = sticks & ~np.maximum.accumulate(side[rows] > 1e-3)
        f[rows] = -(150 * np.minimum(d[rows], 0.8e-3) * on)[:, None] * ways(null)[rows]
        sticks = bool(on[-1])
    return f


def tack(null):
    """A tacky tool: the longer it has touched, the more it is held back on its way out."""
    d, f = depth(null), np.zeros_like(null.f)
    for rows in presses(null):
        back = 1 - d[rows] / np.maximum(np.maximum.accumulate(d[rows]), 1e-9)
        held = 0.15 * np.log1p(since(null)[rows] / 0.3) * np.minimum(back / 0.4, 1)
        f[rows] = held[:, None] * ways(null)[rows]
    return f


def unscrews(null):
    """The tool has a thread: each push towards +x screws it out by a part, each other way in again."""
    side, length, out = along_surface(null.u, normals(null)), np.zeros(len(null.t)), 0.0
    for rows in presses(null):
        length[rows] = out
        out += 0.2 * side[rows[-1], 0]
    return longer(null, length)


def treads(null):
    """A ribbed tool on ribbed skin: sideways it climbs over a rib each 1.3 mm, held before it and helped on behind."""
    n = normals(null)
    side, load = along_surface(null.u, n), np.abs((null.f * n).sum(axis=1))
    by = np.maximum(np.linalg.norm(side, axis=1), 1e-9)
    return -(0.15 * load * np.sin(2 * np.pi * by / 1.3e-3) / by)[:, None] * side


def crisp(null):
    """Crisp cells break one by one where a place is pressed deeper than ever; what is broken stays soft."""
    d, factor, broken = depth(null), np.ones(len(null.t)), {}
    for rows in presses(null):
        key = tuple(null.x[rows[0]])
        before = broken.get(key, 0.0)
        breaks = d[rows] > before + 1e-6
        factor[rows] = np.where(breaks, 0.85 + 0.4 * (d[rows] / 0.9e-3 % 1 - 0.5), 0.8)
        broken[key] = max(before, d[rows].max())
    return factor


def thaws(null):
    """The body comes from the freezer: what is stiff under its surface lies deeper as time goes on."""
    front = 1e-3 + 5e-3 * np.sqrt(share(null))
    return -100 * np.maximum(0, depth(null) - front)[:, None] * ways(null)


def milked(null):
    """Vessels with valves: pushes towards +y drain a limb, and it is softer; pushes back, and 400 s, fill it."""
    side, factor, fill, last = along_surface(null.u, normals(null)), np.ones(len(null.t)), 0.0, null.t[0]
    for rows in presses(null):
        fill *= np.exp(-(null.t[rows[0]] - last) / 400)
        factor[rows] = 1 + 0.2 * fill
        fill, last = fill - side[rows[-1], 1] / 2e-3, null.t[rows[-1]]
    return factor


def ballots(null):
    """Tapped faster than 6 mm/s a lump sinks off in its liquid, comes back and knocks, and once more."""
    f = np.zeros_like(null.f)
    for rows in presses(null):
        v = np.linalg.norm(np.diff(null.u[rows], axis=0), axis=1) / np.diff(null.t[rows])
        hard, s = np.clip(v.max() / 6e-3 - 1, 0, 1), since(null)[rows]
        knock = np.exp(-((s - 0.7) / 0.15) ** 2) + 0.5 * np.exp(-((s - 1.5) / 0.2) ** 2)
        f[rows] = -0.2 * hard * knock[:, None] * ways(null)[rows]
    return f


def confined(null):
    """The body stands in a box: pushed sideways towards a wall that is near it gives way less."""
    places, side = np.unique(null.x, axis=0), along_surface(null.u, normals(null))
    middle, half = (places.max(axis=0) + places.min(axis=0)) / 2, np.ptp(places, axis=0) / 2
    off = ((null.x - middle) / np.maximum(half, 1e-9))[:, :2]
    towards = np.maximum(0, side[:, :2] * np.sign(off)) * np.sign(off) * off ** 2
    return np.column_stack([-150 * towards, np.zeros(len(null.t))])


def holds_breath(null):
    """Who is pressed past 2.5 mm holds his breath, as it is then, until he is let go."""
    still = np.zeros(len(null.t))
    for rows in presses(null):
        past = np.flatnonzero(depth(null)[rows] > 2.5e-3)
        still[rows] = np.minimum(null.t[rows], null.t[rows[past[0]]]) if len(past) else null.t[rows]
    return null.forces(null.u - np.outer(np.sin(2 * np.pi * 0.36 * still), (0, 0, 0.4e-3)))


def homes(null):
    """Every seventh press the robot looks for its home anew, and finds it up to 0.5 mm too high or low."""
    random, length = np.random.default_rng(53), np.zeros(len(null.t))
    for k, rows in enumerate(presses(null)):
        if k % 7 == 0:
            off = random.uniform(-0.5e-3, 0.5e-3)
        length[rows] = off
    return longer(null, length)


def rested(null):
    """What has rested relaxes; pressed again within a minute or so it has little left to relax."""
    relaxing, f = RELAX(null) - null.f, null.f.copy()
    for rows, pause in pauses(null):
        f[rows] += relaxing[rows] * (1 - np.exp(-pause / 80))
    return f


def spreads(null):
    """Liquid is pressed out of a place, seeps through the body, and makes the next ones firmer, the further the later."""
    load, factor, before = np.linalg.norm(null.f, axis=1), np.ones(len(null.t)), []
    for rows in presses(null):
        for place, t, much in before:
            away = np.linalg.norm(null.x[rows[0]] - place)
            if away > 1e-6:
                age = (null.t[rows[0]] - t) / (60 * (away / 0.03) ** 2)
                factor[rows] += 0.3 * much * np.exp(-away / 0.03) * age * np.exp(1 - age)
        before.append((null.x[rows[0]], null.t[rows[-1]], load[rows].max()))
    return factor


def cold_oil(null):
    """A hydraulic drive follows what it is told, and late: its oil is cold and thick after a pause."""
    u = null.u.copy()
    for rows, pause in pauses(null):
        tau = 0.03 + 0.2 * (1 - np.exp(-pause / 80))
        for a, b in zip(rows[:-1], rows[1:]):
            u[b] = null.u[b] + (u[a] - null.u[b]) * np.exp(-(null.t[b] - null.t[a]) / tau)
    return null.forces(u)


def averages_sweeps(null):
    """The scope is left on averaging: a fifth of each press is what it had of the presses before."""
    f, every = null.f.copy(), presses(null)
    for before, rows in zip(every[:-1], every[1:]):
        for k in range(3):
            old = np.interp(since(null)[rows], since(null)[before], f[before, k])
            f[rows, k] = 0.8 * null.f[rows, k] + 0.2 * old
    return f


def axes_part(null):
    """The axes' three amplifiers warm up, each in its time: z reads more by and by, y less, and x less at once."""
    s = null.t - null.t[0]
    warm = np.stack([-0.3 * (1 - np.exp(-s / 150)), -0.25 * s / s[-1], 0.15 * s / s[-1]], axis=1)
    return null.f * (1 + warm)


LABORATORY = [
    ("peak-hold", peak_hold, "history", ["sensor-hysteresis", "sensor-lag"], {"path": back_and_forth}),
    ("lost-nought", lost_nought, "depth axes", ["sensor-curve"], {}),
    ("tares-late", tares_late, "offset speed", ["tare"], {}),
    ("light-leak", plus(light_leak), "depth offset", [], {}),
    ("notched", notched, "history speed", ["filter"], {}),
    ("cracked-wire", cracked_wire, "direction event axes", [], {}),
]
TOOL = [
    ("spins", plus(spins), "direction axes", [], {}),
    ("edge-first", times(edge_first), "direction depth", [], {}),
    ("crumb", plus(crumb), "order event depth", [], {}),
    ("tack", plus(tack), "history depth", ["adhesion"], {"path": back_and_forth}),
    ("unscrews", unscrews, "order session offset", ["touch", "tare"], {}),
    ("treads", plus(treads), "direction", [], {}),
]
BODY = [
    ("crisp", times(crisp), "depth order event", ["plastic", "softening"], {}),
    ("thaws", plus(thaws), "session depth", ["temperature", "ageing"], {}),
    ("milked", times(milked), "order session", [], {}),
    ("ballots", plus(ballots), "speed history event", [], {}),
    ("confined", plus(confined), "place direction", [], {}),
    ("holds-breath", holds_breath, "frequency depth", ["breathing"], {}),
]
TIME = [
    ("homes", homes, "session event offset", ["touch", "tare"], {}),
    ("rested", rested, "history order", ["viscoelastic"], {}),
    ("spreads", times(spreads), "order place session", [], {}),
    ("cold-oil", cold_oil, "history speed order", ["sensor-lag", "filter"], {}),
    ("averages-sweeps", averages_sweeps, "order", [], {}),
    ("axes-part", axes_part, "session axes", [], {}),
]


def every_stray():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in LABORATORY + TOOL + BODY + TIME for k in SIZES]
