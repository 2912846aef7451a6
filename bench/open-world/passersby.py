"""Causes that no effect of the catalogue covers, of the laboratory, of the tool, of the body and
of time by five each, written down from the catalogue's list and the files of the causes before
them alone; kinds and names as in strangers.py, fixed before anything was diagnosed."""
import numpy as np

from callers import nearer, ways
from causes import Cause, presses
from drifters import fastest, off_middle
from strangers import GAINS, SIZES, depth, plus, ramp_ends, share, shifted, since, sized, times
from visitors import along_surface, normals


def stretched(null):
    """The sensor's box takes 130 values a second and files them as 100: each press' forces go on more slowly."""
    return shifted(null, since(null) * (1 / 1.3 - 1))


def elbow(null):
    """In two presses of three someone rests his elbow on the plate for a second or so, whatever is pressed."""
    random, f = np.random.default_rng(81), np.zeros_like(null.f)
    for rows in presses(null):
        s, how_long = since(null)[rows] - random.uniform(0.3, 1.3), random.uniform(0.6, 1.2)
        leans = (random.random() < 0.65) * np.clip(np.minimum(s, how_long - s) / 0.1, 0, 1) * random.uniform(0.5, 1)
        f[rows] = np.outer(leans, (0.06, -0.1, -0.25))
    return f


def picks_up(null):
    """In the flat cable the wires of x and y lie beside that of z, and pick up its changes, not what stays."""
    f = np.zeros_like(null.f)
    for rows in presses(null):
        rate = np.diff(null.f[rows, 2]) / np.diff(null.t[rows])
        f[rows[1:]] = np.outer(rate, (0.06, -0.04, 0))
    return f


def two_fans(null):
    """Two fans, of 5.1 and 5.33 turns a second, shake the bench; together they swell and fade within 4 s."""
    w = 2 * np.pi * null.t
    return np.outer(np.sin(5.1 * w) + np.sin(5.33 * w + 1), (0.06, 0.04, 0.09))


def rubber_feet(null):
    """The plate stands on rubber feet, that are soft at first: 2 mm go into them, nearly all by the first 0.3 N."""
    lost = np.zeros(len(null.t))
    for _ in range(60):
        load = np.linalg.norm(nearer(null, -lost), axis=1)
        lost += 0.2 * (2e-3 * (1 - np.exp(-load / 0.1)) - lost)
    return nearer(null, -lost)


def runs_on(null):
    """A drive without a brake runs on after its stop, by what it goes in 60 ms, and stays there; nobody records it."""
    height = np.zeros(len(null.t))
    for rows, end in zip(presses(null), ramp_ends(null)):
        after = np.maximum(null.t[rows] - null.t[end], 0)
        height[rows] = 0.06 * fastest(null, rows) * (1 - np.exp(-after / 0.04))
    return nearer(null, height)


def parks(null):
    """0.7 s after the drive has stopped its brake closes, and thereby shoves the tool 0.8 mm further in."""
    height = np.zeros(len(null.t))
    for rows, end in zip(presses(null), ramp_ends(null)):
        height[rows] = 0.8e-3 * (null.t[rows] - null.t[end] > 0.7)
    return nearer(null, height)


def long_reach(null):
    """The arm's foot is at the side of -x: the further out it reaches, the more it gives, by the cube of its length."""
    reach = 0.65 + 0.35 * off_middle(null)[:, 0]
    give = 2e-3 * (reach ** 3)[:, None, None]
    return np.linalg.solve(np.eye(3) - give * null.K, null.forces(null.u)[:, :, None])[:, :, 0]


def twists(null):
    """The sensor sits on a spiral spring that turns about z as it is loaded, by 40 deg/N, and its axes with it."""
    angle = np.radians(40) * np.abs(null.f[:, 2])
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = null.f.T
    return np.stack([c * x - s * y, s * x + c * y, z], axis=1)


def snags(null):
    """In one press of two or three, by chance, the tool's hose is caught on its way in, and pulls from there on."""
    random, f = np.random.default_rng(82), np.zeros_like(null.f)
    for rows in presses(null):
        d = depth(null)[rows]
        caught, there = random.uniform(0.2, 0.7) * d.max(), random.random() < 0.45
        f[rows] = np.outer(there * np.maximum(0, d - caught), (50, -40, 60))
    return f


def shivers(null):
    """A cold body shivers at 5.6 Hz, in bouts of some 40 s with as much rest and more, stronger as it cools."""
    bout = np.maximum(0, np.sin(2 * np.pi * null.t / 97))
    return nearer(null, 1.2e-3 * (0.3 + share(null)) * bout * np.sin(2 * np.pi * 5.6 * null.t))


def wrinkled(null):
    """Since it was scanned the skin has wrinkled: each place is, by chance, some tenths of a mm higher or lower."""
    places = np.unique(null.x, axis=0)
    heights = np.random.default_rng(83).normal(0, 0.4e-3, len(places))
    return nearer(null, heights[np.linalg.norm(null.x[:, None] - places, axis=2).argmin(axis=1)])


def plateau(null):
    """The body is a honeycomb: from 1 to 3 mm its walls fold and the load hardly grows, then they pack firm."""
    d = np.maximum(depth(null), 1e-9)
    return (np.minimum(d, 1e-3) + 1.3 * np.maximum(0, d - 3e-3)) / d


def shingles(null):
    """Scales overlap: pushed towards +y they wedge and all bears more, towards -y they spread and bear less."""
    return 1 + along_surface(ways(null), normals(null))[:, 1]


def blushes(null):
    """Blood rushes to where was pressed, within half a minute: there, and near it, it is firmer for some minutes."""
    factor, before = np.ones(len(null.t)), []
    for rows in presses(null):
        for place, t, deep in before:
            away, ago = np.linalg.norm(null.x[rows[0]] - place), null.t[rows[0]] - t
            factor[rows] += 60 * deep * np.exp(-away / 25e-3) * (np.exp(-ago / 200) - np.exp(-ago / 20))
        before.append((null.x[rows[0]], null.t[rows[-1]], depth(null)[rows].max()))
    return factor


def cold_air(null):
    """The room's cooling is on for 250 s and off for 250 s; the gel follows within 100 s, and is firmer when cold."""
    t, cold, factor = null.t, 0.0, np.ones(len(null.t))
    for a, b in zip(range(len(t) - 1), range(1, len(t))):
        for s in np.linspace(t[a], t[b], 1 + int(np.ceil((t[b] - t[a]) / 5)))[1:]:
            cold += (float(s % 500 < 250) - cold) * (1 - np.exp(-min(t[b] - t[a], 5) / 100))
        factor[b] = 1 + 0.3 * cold
    return factor


def tares_early(null):
    """The next press is tared while the tool still leaves the last place: a part of that load is taken off."""
    f = np.zeros_like(null.f)
    for before, rows in zip(presses(null)[:-1], presses(null)[1:]):
        f[rows] = -0.2 * null.f[before[-1]]
    return f


def fills_up(null):
    """A logger whose memory fills smooths over more and more: over nothing at first, over 0.4 s at the end."""
    f, tau = null.f.copy(), 0.4 * share(null)
    for rows in presses(null):
        for a, b in zip(rows[:-1], rows[1:]):
            f[b] = null.f[b] + (f[a] - null.f[b]) * np.exp(-(null.t[b] - null.t[a]) / max(tau[b], 1e-6))
    return f


def leg_sinks(null):
    """A leg of the frame sinks into a soft floor: by and by all ways lean over about y, by 20 deg at the end."""
    angle = np.radians(20) * share(null)
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = null.u.T
    return null.forces(np.stack([c * x + s * z, y, c * z - s * x], axis=1))


def chipped(null):
    """After a quarter of the session the tool's rim is chipped at one side: pushed towards +x and +y it slips away."""
    n, side = normals(null), along_surface(null.f, normals(null))
    to = along_surface(ways(null), n) @ (0.7, 0.7, 0)
    return null.f - (0.7 * (share(null) > 0.25) * np.clip(to / 0.15, 0, 1))[:, None] * side


LABORATORY = [
    ("stretched", stretched, "speed history", [], {}),
    ("elbow", plus(elbow), "event offset", [], {}),
    ("picks-up", plus(picks_up), "axes speed history", [], {}),
    ("two-fans", plus(two_fans), "frequency", ["sensor-hum"], {}),
    ("rubber-feet", rubber_feet, "depth", ["learned-depth"], {}),
]
TOOL = [
    ("runs-on", runs_on, "speed history", [], {}),
    ("parks", parks, "history event", [], {}),
    ("long-reach", long_reach, "place", ["arm-compliance", "learned-place"], {}),
    ("twists", twists, "axes direction depth", [], {}),
    ("snags", plus(snags), "event", [], {}),
]
BODY = [
    ("shivers", shivers, "frequency session", ["breathing"], {}),
    ("wrinkled", wrinkled, "place offset", [], {}),
    ("plateau", times(plateau), "depth", ["learned-depth"], {}),
    ("shingles", times(shingles), "direction", [], {}),
    ("blushes", times(blushes), "order place session", [], {}),
]
TIME = [
    ("cold-air", times(cold_air), "session", GAINS + ["temperature"], {}),
    ("tares-early", plus(tares_early), "order offset", ["tare"], {}),
    ("fills-up", fills_up, "session history speed", ["sensor-lag", "filter"], {}),
    ("leg-sinks", leg_sinks, "session direction set-up", ["motion-rotation"], {}),
    ("chipped", chipped, "session direction event", [], {}),
]


def every_passerby():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in LABORATORY + TOOL + BODY + TIME for k in SIZES]
