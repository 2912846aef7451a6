"""Causes that no effect of the catalogue covers, of the laboratory, of the tool, of the body and
of time by six each, written down from the catalogue's list and the files of the causes before
them alone; kinds and names as in strangers.py, fixed before anything was diagnosed."""
import numpy as np

from causes import Cause, back_and_forth, presses
from strangers import SIZES, depth, plus, share, shifted, since, sized, speed, times
from visitors import along_surface, normals


def ways(null):
    """(n, 3), of each press the way it goes at its deepest."""
    way = np.zeros_like(null.u)
    for rows in presses(null):
        deepest = null.u[rows[np.argmax(depth(null)[rows])]]
        way[rows] = deepest / np.linalg.norm(deepest)
    return way


def nearer(null, height):
    """The forces where the surface is nearer by height (n) [m], or further off and touched later."""
    way = ways(null)
    return null.forces(way * np.maximum(0, depth(null) + height)[:, None] + null.u - way * depth(null)[:, None])


def despikes(null):
    """Software takes what is 0.05 N off the last good sample for a spike, and repeats that, but eight times at most."""
    f = null.f.copy()
    for rows in presses(null):
        for k in range(3):
            good, skipped = null.f[rows[0], k], 0
            for row in rows:
                if abs(null.f[row, k] - good) > 0.05 and skipped < 8:
                    f[row, k], skipped = good, skipped + 1
                else:
                    good, skipped = null.f[row, k], 0
    return f


def smooths_across(null):
    """A mean over eleven samples to both sides, taken of the file's column as if it were one press."""
    padded = np.concatenate([null.f[:1]] * 5 + [null.f] + [null.f[-1:]] * 5)
    return np.stack([np.convolve(padded[:, k], np.ones(11) / 11, "valid") for k in range(3)], axis=1)


def tilt_short(null):
    """The wrist tilts to the press' way by a sixth less than it says, and forces are turned back by what it says."""
    f, down = null.f.copy(), np.array([0, 0, -1.0])
    for rows in presses(null):
        way = ways(null)[rows[0]]
        axis, angle = np.cross(down, way), np.arccos(np.clip(way @ down, -1, 1)) / 6
        if np.linalg.norm(axis) > 1e-6:
            a, g = axis / np.linalg.norm(axis), null.f[rows]
            f[rows] = g * np.cos(angle) + np.cross(a, g) * np.sin(angle) + np.outer(g @ a, a) * (1 - np.cos(angle))
    return f


def dead_bit(null):
    """One bit of a converter, worth 0.13 N of the axis along z, is always read as nought."""
    f = null.f.copy()
    f[:, 2] -= 0.13 * (np.floor(null.f[:, 2] / 0.13) % 2)
    return f


def droops(null):
    """The arm's position loop gives way by 3 mm/N, and its integral part takes that back within 0.7 s."""
    f, C = null.f.copy(), 3e-3
    for rows in presses(null):
        K, back = null.K[rows[0]], np.zeros(3)
        for a, b in zip(rows[:-1], rows[1:]):
            back = f[a] + (back - f[a]) * np.exp(-(null.t[b] - null.t[a]) / 0.7)
            f[b] = np.linalg.solve(np.eye(3) - C * K, K @ (null.u[b] - C * back))
    return f


def brake(null):
    """As a press begins a joint's brake is let go; its coil's current is in the bridge and dies away."""
    return np.outer(np.exp(-since(null) / 0.45), (0.08, -0.1, 0.25))


def sealed_air(null):
    """A hollow tool seals if it comes straight, and its air bears a part until it has leaked out; askew it does not."""
    n, d, held = normals(null), depth(null), np.zeros(len(null.t))
    straight = np.exp(-(np.degrees(np.arccos(np.clip(-(ways(null) * n).sum(axis=1), -1, 1))) / 8) ** 2)
    for rows in presses(null):
        for a, b in zip(rows[:-1], rows[1:]):
            held[b] = (held[a] + 75 * (d[b] - d[a])) * np.exp(-(null.t[b] - null.t[a]) / 0.5)
    return (straight * held)[:, None] * n


def trocar(null):
    """The shaft goes through a port along z and rubs by what it is pressed aside, against its last motion."""
    f, v = np.zeros_like(null.f), speed(null)
    for rows in presses(null):
        last = 0.0
        for row in rows:
            last = -np.sign(v[row]) if abs(v[row]) > 1e-9 else last
            f[row, 2] = last
    return f * 0.4 * np.linalg.norm(null.f[:, :2], axis=1)[:, None]


def crusted(null):
    """Every press leaves a crust on the tool's rim, that claws into the skin when it goes aside, the more the later."""
    every = presses(null)
    crust = np.zeros(len(null.t))
    for k, rows in enumerate(every):
        crust[rows] = k / len(every)
    return -120 * crust[:, None] * along_surface(null.u, normals(null))


def meniscus(null):
    """Water between tool and skin sucks as soon as it is touched; it dries within 450 s, and is put on each 600 s."""
    wet = np.maximum(0, 1 - (null.t - null.t[0]) % 600 / 450)
    return (-0.2 * wet * (1 - np.exp(-depth(null) / 0.3e-3)))[:, None] * normals(null)


def hand_shakes(null):
    """The tool is held by hand, which trembles along its way, the more the longer and the harder it has to hold."""
    load = np.linalg.norm(null.f, axis=1)
    wave = np.sin(2 * np.pi * 8.3 * null.t + 3 * np.sin(2 * np.pi * 0.4 * null.t))
    return null.forces(null.u + (0.6e-3 * load / load.max() * since(null) / 2 * wave)[:, None] * ways(null))


def hot_tip(null):
    """A warm tool melts the gel under it, deeper by the root of the time since it touched."""
    return 1 - 0.2 * np.sqrt(since(null))


def tears(null):
    """The skin of a place tears when first pressed past 4.6 mm: the force drops, and there it stays low for good."""
    factor, torn = np.ones(len(null.t)), set()
    for rows in presses(null):
        key = tuple(null.x[rows[0]])
        for row in rows:
            if depth(null)[row] > 4.6e-3:
                torn.add(key)
            factor[row] = 0.6 if key in torn else 1.0
    return factor


def jerks(null):
    """Touched, the body jerks against the tool some 0.8 s later; it gets used to that, and forgets in pauses."""
    f, alert, last = np.zeros_like(null.f), 1.0, null.t[0]
    for rows in presses(null):
        alert = 1 + (alert - 1) * np.exp(-(null.t[rows[0]] - last) / 150)
        f[rows] = -0.35 * alert * np.exp(-((since(null)[rows] - 0.8) / 0.4) ** 2)[:, None] * ways(null)[rows]
        alert, last = 0.5 * alert, null.t[rows[-1]]
    return f


def cuff(null):
    """An artery's pulse comes through most where the tool's load is that of the blood, less if lighter or harder."""
    load, w = np.linalg.norm(null.f, axis=1), 2 * np.pi * 1.15 * null.t
    wave = np.sin(w) + 0.4 * np.sin(2 * w + 0.8)
    return (-0.17 * np.exp(-((load - 0.65) / 0.3) ** 2) * wave)[:, None] * ways(null)


def waterbed(null):
    """Each press drives liquid from its half of the body to the other, which gets firmer; it flows back in 200 s."""
    load, factor, over, last = np.linalg.norm(null.f, axis=1), np.ones(len(null.t)), 0.0, null.t[0]
    side = np.where(null.x[:, 1] > np.median(np.unique(null.x, axis=0)[:, 1]), 1, -1)
    for rows in presses(null):
        over *= np.exp(-(null.t[rows[0]] - last) / 200)
        factor[rows] = 1 + 0.25 * side[rows] * over
        over, last = over - side[rows[0]] * load[rows].max() / load.max(), null.t[rows[-1]]
    return factor


def uncrimps(null):
    """Fibres in the skin lie in waves; drawn straight, 1 mm sideways, they hold the tool back beside what there was."""
    side = along_surface(null.u, normals(null))
    s = np.maximum(np.linalg.norm(side, axis=1), 1e-9)
    return -side * (140 * np.maximum(0, s - 1e-3) / s)[:, None]


def tendon(null):
    """A cord lies under the middle places; it bears a part until it rolls off aside at 2.6 mm, and leans on the tool."""
    x = np.unique(null.x, axis=0)[:, 0]
    low, middle, high = np.quantile(x, (0.25, 0.5, 0.75))
    f, d = np.zeros_like(null.f), depth(null)
    for rows in presses(null):
        at = null.x[rows[0], 0]
        if low <= at <= high:
            off = np.maximum.accumulate(d[rows] > 2.6e-3)[:, None]
            f[rows] = np.where(off, (0.1 * np.sign(at - middle), 0, 0), -90 * d[rows, None] * ways(null)[rows])
    return f


def clock_slips(null):
    """The sensor's clock goes wrong by 0.2 s in 400 s, then it is set anew."""
    return shifted(null, -0.2 * ((null.t - null.t[0]) / 400 % 1))


def bumped(null):
    """Someone bumps the table: from then on one end of the body is 0.6 mm nearer than when scanned, the other further."""
    y = null.x[:, 1] - (null.x[:, 1].max() + null.x[:, 1].min()) / 2
    return nearer(null, 0.6e-3 * y / y.max() * (share(null) > 0.45))


def reboots(null):
    """After a power cut the amplifier is back with the filter of the factory, of 0.2 s."""
    f = null.f.copy()
    for rows in presses(null):
        if share(null)[rows[0]] > 0.55:
            for a, b in zip(rows[:-1], rows[1:]):
                f[b] = null.f[b] + (f[a] - null.f[b]) * np.exp(-(null.t[b] - null.t[a]) / 0.2)
    return f


def sways(null):
    """The arm still sways from its way there when it presses, by how far it came, along where it came from."""
    u, at = null.u.copy(), null.x[0]
    for rows in presses(null):
        s, travel = since(null)[rows], (null.x[rows[0]] - at) * (1, 1, 0)
        grip = 1 - np.exp(-depth(null)[rows] / 0.5e-3)
        u[rows] += np.outer(0.02 * grip * np.exp(-s / 2.5) * np.cos(2 * np.pi * 2.3 * s), travel)
        at = null.x[rows[0]]
    return null.forces(u)


def grease(null):
    """The slide's grease resists motion, less the more it was worked; in pauses of a minute or two it sets again."""
    f, stiff, last = np.zeros_like(null.f), 1.0, null.t[0]
    for rows in presses(null):
        stiff = 1 + (stiff - 1) * np.exp(-(null.t[rows[0]] - last) / 100)
        v = speed(null)[rows]
        f[rows, 2] = -0.25 * stiff * np.sign(v) * np.sqrt(np.abs(v) / 10e-3)
        stiff, last = 0.3 * stiff, null.t[rows[-1]]
    return f


def sinks_in(null):
    """The body lies on foam that keeps a dent of each load for a minute or so: who presses soon after finds it lower."""
    load, dent, height, last = np.linalg.norm(null.f, axis=1), 0.0, np.zeros(len(null.t)), null.t[0]
    for rows in presses(null):
        dent *= np.exp(-(null.t[rows[0]] - last) / 60)
        height[rows] = -dent
        dent, last = dent + 1e-3 * load[rows].mean(), null.t[rows[-1]]
    return nearer(null, height)


LABORATORY = [
    ("despikes", despikes, "history speed event", [], {}),
    ("smooths-across", smooths_across, "history speed order", ["filter"], {}),
    ("tilt-short", tilt_short, "direction axes set-up", [], {}),
    ("dead-bit", dead_bit, "depth axes event", [], {}),
    ("droops", droops, "history speed", ["sensor-lag"], {}),
    ("brake", plus(brake), "history offset", [], {}),
]
TOOL = [
    ("sealed-air", plus(sealed_air), "history direction speed", ["viscoelastic"], {}),
    ("trocar", plus(trocar), "direction history axes", ["drag"], {"path": back_and_forth}),
    ("crusted", plus(crusted), "direction order session", [], {}),
    ("meniscus", plus(meniscus), "session offset", ["adhesion", "tare"], {}),
    ("hand-shakes", hand_shakes, "frequency history depth", ["breathing"], {}),
    ("hot-tip", times(hot_tip), "history", ["viscoelastic", "fractional", "temperature"], {}),
]
BODY = [
    ("tears", times(tears), "event depth order", ["softening"], {}),
    ("jerks", plus(jerks), "history order event", [], {}),
    ("cuff", plus(cuff), "frequency depth", ["breathing"], {}),
    ("waterbed", times(waterbed), "order place session", [], {}),
    ("uncrimps", plus(uncrimps), "direction depth", ["anisotropic"], {}),
    ("tendon", plus(tendon), "place depth event", ["inclusion"], {}),
]
TIME = [
    ("clock-slips", clock_slips, "history speed session", ["clock"], {}),
    ("bumped", bumped, "session place offset event", ["touch", "tare"], {}),
    ("reboots", reboots, "session event history speed", ["filter", "sensor-lag"], {}),
    ("sways", sways, "frequency history order", [], {}),
    ("grease", plus(grease), "speed order session", ["damper", "drag"], {"path": back_and_forth}),
    ("sinks-in", sinks_in, "order depth offset", ["touch", "tare"], {}),
]


def every_caller():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in LABORATORY + TOOL + BODY + TIME for k in SIZES]
