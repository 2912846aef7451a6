"""Causes that no effect of the catalogue covers, of the laboratory, of the tool, of the body and
of time by six each, written down from the catalogue's list and the benchmark's earlier causes,
without the diagnosis' code; kinds and names as in strangers.py, fixed before anything was
diagnosed."""
import numpy as np

from causes import Cause, back_and_forth, presses
from strangers import SIZES, depth, plus, share, shifted, since, sized, times
from visitors import along_surface, normals


def pauses(null):
    """Each press's rows, and how long before it nothing was pressed [s]; the first: for ever."""
    every = presses(null)
    ends = [-np.inf] + [null.t[rows[-1]] for rows in every[:-1]]
    return [(rows, null.t[rows[0]] - end) for rows, end in zip(every, ends)]


def ground_loop(null):
    """A wet body closes a ground loop: mains, 8.3 Hz as sampled, by the area that is touched."""
    area = np.minimum(depth(null) / 4e-3, 1)
    return np.outer(area * np.sin(2 * np.pi * 8.3 * null.t), (0.06, -0.04, 0.12))


def thermostat(null):
    """A heater's relay is on for 38 s in every 97 s; its current shifts the zero while it is."""
    return np.outer((null.t - null.t[0] + 20) % 97 < 38, (0.05, -0.03, 0.09))


def parallax(null):
    """Motion is taken by one camera 0.2 m above: what goes down seems to go towards the middle."""
    places = np.unique(null.x, axis=0)
    out, seen = null.x - places.mean(axis=0), np.zeros_like(null.u)
    seen[:, :2] = out[:, :2] * null.u[:, 2:] / 0.2
    return null.forces(null.u - seen)


def auto_gain(null):
    """An amplifier sets its gain, high at rest, by what it puts out: down in 1 s, up again in 3 s."""
    factor, load = np.full(len(null.t), 1.5), np.linalg.norm(null.f, axis=1)
    for rows in presses(null):
        level = 0.0
        for a, b in zip(rows[:-1], rows[1:]):
            puts = load[b] * factor[a]
            level += (puts - level) * (1 - np.exp(-(null.t[b] - null.t[a]) / (1 if puts > level else 3)))
            factor[b] = 1.5 / (1 + level)
    return factor


def stuck_bit(null):
    """The converter's bit of 0.1 N is stuck at one: where it should be zero that much is added."""
    code = np.floor((null.f + 0.05) / 0.1)
    return 0.1 * (code % 2)


def detrended(null):
    """A script takes the line through each press for drift, and subtracts up to 0.04 N/s of it."""
    f = null.f.copy()
    for rows in presses(null):
        s = null.t[rows] - null.t[rows[0]]
        slope = np.polyfit(s, null.f[rows], 1)[0]
        f[rows] -= np.outer(s, np.clip(slope, -0.04, 0.04))
    return f


def foam(null):
    """A foam tip stays flat after a press and rises within 100 s: what it rose is lost at first."""
    d, factor = np.maximum(depth(null), 1e-9), np.ones(len(null.t))
    for rows, pause in pauses(null):
        risen = 1.6e-3 * (1 - np.exp(-pause / 100))
        factor[rows] = 1 - np.minimum(risen, 0.75 * d[rows]) / d[rows]
    return factor


def shank(null):
    """Sideways past 0.8 mm the tool's shank leans on the wall of the dent, more if it is deep in."""
    side = along_surface(null.u, normals(null))
    by = np.maximum(np.linalg.norm(side, axis=1), 1e-9)
    leans = np.maximum(0, by - 0.8e-3) * np.minimum(depth(null) / 4e-3, 1.5)
    return -100 * (leans / by)[:, None] * side


def rubs_dry(null):
    """Each press of a place rubs off what wets it: at first the tool slips there, later it holds."""
    n, f, count = normals(null), null.f.copy(), {}
    side = along_surface(null.f, n)
    for rows in presses(null):
        key = tuple(null.x[rows[0]])
        most = (0.35 - 0.3 * 0.6 ** count.get(key, 0)) * np.abs((null.f[rows] * n[rows]).sum(axis=1))
        by = np.maximum(np.linalg.norm(side[rows], axis=1), 1e-9)
        f[rows] -= 0.8 * (np.maximum(0, by - most) / by)[:, None] * side[rows]
        count[key] = count.get(key, 0) + 1
    return f


def corners(null):
    """The tool is square: sideways with a flat flank first it is held more than a corner first."""
    n = normals(null)
    side, push = along_surface(null.u, n), along_surface(null.f, n)
    flat = np.cos(4 * (np.arctan2(side[:, 1], side[:, 0]) - 0.4))
    return 0.5 * flat[:, None] * push


def clicks(null):
    """A clutch slips by a tooth, 1 mm, at 0.5 N and each 0.3 N more; set back after the press."""
    d, factor, load = np.maximum(depth(null), 1e-9), np.ones(len(null.t)), np.linalg.norm(null.f, axis=1)
    for rows in presses(null):
        teeth = 0
        for row in rows:
            factor[row] = max(0.0, 1 - 1e-3 * teeth / d[row])
            if load[row] * factor[row] > 0.5 + 0.3 * teeth:
                teeth += 1
                factor[row] = max(0.0, 1 - 1e-3 * teeth / d[row])
    return factor


def hose(null):
    """The tool's hose has kept the bend of the last place: it pulls back there, and eases in 2 s."""
    f, every = np.zeros_like(null.f), presses(null)
    for before, rows in zip(every[:-1], every[1:]):
        f[rows] = 2.5 * np.outer(np.exp(-since(null)[rows] / 2), null.x[before[0]] - null.x[rows[0]])
    return f


def clonus(null):
    """Stretched faster than 5 mm/s a muscle begins to beat, at 4.6 Hz, and calms within 1.2 s."""
    factor = np.ones(len(null.t))
    for rows in presses(null):
        fast = np.linalg.norm(np.diff(null.u[rows], axis=0), axis=1) / np.diff(null.t[rows])
        strong, s = np.clip(fast.max() / 5e-3 - 1, 0, 1), np.maximum(since(null)[rows] - 0.12, 0)
        factor[rows] = 1 + 0.4 * strong * np.exp(-s / 1.2) * np.sin(2 * np.pi * 4.6 * s)
    return factor


def startles(null):
    """Touched, an animal tenses for a second or two; touch by touch it minds less, after a rest more."""
    factor, minds = np.ones(len(null.t)), 1.0
    for rows, pause in pauses(null):
        minds = 1 - (1 - minds) * np.exp(-pause / 400)
        s = np.maximum(since(null)[rows] - 0.15, 0)
        factor[rows] = 1 + minds * (1 - np.exp(-s / 0.1)) * np.exp(-s / 1.2)
        minds *= 0.6
    return factor


def punctures(null):
    """Where a place is first pressed past 5 mm its skin gives at once, and is weaker for good."""
    d, factor, torn = depth(null), np.ones(len(null.t)), set()
    for rows in presses(null):
        key = tuple(null.x[rows[0]])
        for row in rows:
            if d[row] > 5e-3:
                torn.add(key)
            factor[row] = 0.65 if key in torn else 1.0
    return factor


def dodges(null):
    """Under every third place is a firm lump, loose: past 2.5 mm it slips out to the side."""
    places, d = np.unique(null.x, axis=0), depth(null)
    there = np.array([(null.x == p).all(axis=1) for p in places[1::3]]).any(axis=0)
    stays = 1 / (1 + np.exp((d - 2.5e-3) / 0.2e-3))
    push = 0.15 * np.exp(-((d - 2.5e-3) / 0.8e-3) ** 2)
    return null.f * (1 + 0.5 * there * stays)[:, None] + np.outer(there * push, (0.8, -0.6, 0))


def deflates(null):
    """A filled body has a hole: pressing squeezes some out, by load and time, and it gets softer."""
    load, out, gone = np.linalg.norm(null.f, axis=1), np.zeros(len(null.t)), 0.0
    for rows in presses(null):
        out[rows[0]] = gone
        for a, b in zip(rows[:-1], rows[1:]):
            gone += load[b] * (null.t[b] - null.t[a])
            out[b] = gone
    return 0.6 + 0.4 * np.exp(-1.5 * out / gone)


def flinches(null):
    """Pressed past 3 mm the body draws back, from the next presses, and trusts again in 100 s."""
    d, factor, back = np.maximum(depth(null), 1e-9), np.ones(len(null.t)), 0.0
    for rows, pause in pauses(null):
        back *= np.exp(-pause / 100)
        factor[rows] = np.maximum(0, d[rows] - back) / d[rows]
        back = min(1.8e-3, back + 0.6 * max(0.0, d[rows].max() - 3e-3))
    return factor


def resyncs(null):
    """The clock of the forces loses 0.5 ms each second, and is set right every 400 s."""
    return shifted(null, -5e-4 * ((null.t - null.t[0] + 150) % 400))


def sunbeam(null):
    """A sunbeam wanders along the body in the session, and softens the places where it lies."""
    y = np.unique(null.x, axis=0)[:, 1]
    beam = y.min() + np.ptp(y) * share(null)
    return 1 - 0.25 * np.exp(-((null.x[:, 1] - beam) / (0.25 * np.ptp(y))) ** 2)


def tires(null):
    """Held by hand: a tremor of 7.7 Hz, larger along each hold and along the session."""
    size = 1e-3 * share(null) * (0.3 + 0.7 * np.minimum(since(null) / 3, 1))
    turn = 2 * np.pi * 7.7 * null.t
    shakes = np.stack([0.6 * np.sin(turn), 0.6 * np.sin(turn + 1), np.cos(turn)], axis=1)
    return null.forces(null.u + size[:, None] * shakes)


def rebooted(null):
    """The electronics are started anew at half time, and the zero warms up a second time."""
    s = null.t - null.t[0]
    again = s - 0.5 * s[-1]
    return np.outer(np.exp(-np.where(again < 0, s, again) / 150), (0.1, 0.07, -0.2))


def wakes(null):
    """A sensor dozes between presses: the longer, the more it reads too little for a second."""
    factor = np.ones(len(null.t))
    for rows, pause in pauses(null):
        factor[rows] = 1 - 0.8 * (1 - np.exp(-pause / 80)) * np.exp(-since(null)[rows] / 0.8)
    return factor


def crust(null):
    """Left alone a place dries to a crust, within 300 s; it breaks at 1.5 mm, and its floes drag."""
    d, f, left = np.maximum(depth(null), 1e-9), np.zeros_like(null.f), {}
    for rows in presses(null):
        key = tuple(null.x[rows[0]])
        dry = 1 - np.exp(-(null.t[rows[0]] - left.get(key, -np.inf)) / 300)
        floes = 0.35 + 0.65 * np.exp(-np.maximum(0, d[rows] - 1.5e-3) / 0.2e-3)
        carries = 0.4 * dry * np.minimum(d[rows] / 1.5e-3, 1) * floes
        f[rows] = -carries[:, None] * null.u[rows] / d[rows, None]
        left[key] = null.t[rows[-1]]
    return f


LABORATORY = [
    ("ground-loop", plus(ground_loop), "frequency depth", ["sensor-hum"], {}),
    ("thermostat", plus(thermostat), "offset session event", ["tare"], {}),
    ("parallax", parallax, "place set-up", [], {}),
    ("auto-gain", times(auto_gain), "depth history", [], {"path": back_and_forth}),
    ("stuck-bit", plus(stuck_bit), "depth axes", ["sensor-curve"], {}),
    ("detrended", detrended, "history offset", [], {}),
]
TOOL = [
    ("foam", times(foam), "order depth", ["tip"], {}),
    ("shank", plus(shank), "direction depth", [], {}),
    ("rubs-dry", rubs_dry, "direction order", ["friction"], {}),
    ("corners", plus(corners), "direction set-up", [], {}),
    ("clicks", times(clicks), "depth event history", [], {"path": back_and_forth}),
    ("hose", plus(hose), "offset order history", ["tare"], {}),
]
BODY = [
    ("clonus", times(clonus), "frequency speed history", [], {}),
    ("startles", times(startles), "history order", [], {}),
    ("punctures", times(punctures), "event order place", ["softening"], {}),
    ("dodges", dodges, "place depth", ["inclusion"], {}),
    ("deflates", times(deflates), "session order", ["ageing"], {}),
    ("flinches", times(flinches), "order session", ["touch"], {}),
]
TIME = [
    ("resyncs", resyncs, "speed history session", ["clock"], {}),
    ("sunbeam", times(sunbeam), "place session", ["temperature"], {}),
    ("tires", tires, "frequency session", ["breathing"], {}),
    ("rebooted", plus(rebooted), "session offset event", ["sensor-settling", "sensor-drift", "tare"], {}),
    ("wakes", times(wakes), "history order", [], {}),
    ("crust", plus(crust), "order depth event", [], {}),
]


def every_guest():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in LABORATORY + TOOL + BODY + TIME for k in SIZES]
