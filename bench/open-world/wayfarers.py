"""Causes that no effect of the catalogue covers, five of the laboratory, five of the tool, six of
the body and six of handling and time, written down from the catalogue's list and the files of the
causes before them alone; kinds and names as in strangers.py, fixed before anything was diagnosed."""
import numpy as np

from callers import nearer, ways
from causes import Cause, presses
from drifters import off_middle
from strangers import SIZES, depth, plus, share, shifted, since, sized, times
from visitors import along_surface, normals


def velocity(null, of):
    """Of a column or columns (n, ...), backward over a sample, by the second."""
    v = np.zeros_like(of)
    for rows in presses(null):
        v[rows[1:]] = (np.diff(of[rows], axis=0).T / np.diff(null.t[rows])).T
    return v


def phone(null):
    """In one press of two a phone on the bench looks for its mast: for a second its pulses are in all the bridges."""
    random, f = np.random.default_rng(91), np.zeros_like(null.f)
    for rows in presses(null):
        s, pulse = since(null)[rows] - random.uniform(0, 1.4), random.random(len(rows)) < 0.5
        f[rows] = np.outer((random.random() < 0.5) * (s > 0) * (s < 1) * pulse, (0.12, -0.08, 0.2))
    return f


def channel_slips(null):
    """x, y and z come in turn down one line; if a value is lost, each axis shows the next one's till the press ends."""
    random, f = np.random.default_rng(92), null.f.copy()
    for rows in presses(null):
        lost = rows[int(random.uniform(0.1, 0.7) * len(rows)):]
        if random.random() < 0.4:
            f[lost] = null.f[lost][:, [1, 2, 0]]
    return f


def starves(null):
    """The three axes' amplifiers live on one small supply: z takes the most past 0.5 N, and x and y read less."""
    lacks = np.clip((np.abs(null.f[:, 2]) - 0.5) / 0.4, 0, 1)
    return null.f * np.column_stack([1 - 0.5 * lacks, 1 - 0.5 * lacks, np.ones(len(lacks))])


def compressed(null):
    """To save room a logger stores of each press the first seven cosines, and makes the forces from them again."""
    f = null.f.copy()
    for rows in presses(null):
        n = len(rows)
        waves = np.cos(np.pi * np.outer(np.arange(7), np.arange(n) + 0.5) / n)
        waves /= np.linalg.norm(waves, axis=1)[:, None]
        f[rows] = waves.T @ (waves @ null.f[rows])
    return f


def air_table(null):
    """The body is on a table on air: loaded it sinks and bobs, at 1.4 Hz, until its valves have levelled it again."""
    w, tau, give, parts, f = 2 * np.pi * 1.4, 0.8, 2e-3, 10, null.f.copy()
    for rows in presses(null):
        low, v, valve = 0.0, 0.0, 0.0
        for a, b in zip(rows[:-1], rows[1:]):
            h = (null.t[b] - null.t[a]) / parts
            for i in range(parts):
                load = null.f[a, 2] + (null.f[b, 2] - null.f[a, 2]) * (i + 0.5) / parts + null.K[b, 2, 2] * low
                v += h * (w * w * (give * load - valve - low) - 2 * 0.15 * w * v)
                low += h * v
                valve += h * low / tau
            f[b] = null.K[b] @ (null.u[b] + (0, 0, low))
    return f


def resonates(null):
    """The drive goes by teeth of 0.9 mm; if they come about as often as the arm swings by itself, 5.3 Hz, it swings."""
    w, parts, d, height = 2 * np.pi * 5.3, 10, depth(null), np.zeros(len(null.t))
    for rows in presses(null):
        swing, v = 0.0, 0.0
        for a, b in zip(rows[:-1], rows[1:]):
            h = (null.t[b] - null.t[a]) / parts
            for i in range(parts):
                tooth = (d[a] + (d[b] - d[a]) * (i + 0.5) / parts) / 0.9e-3
                v += h * (w * w * (0.2e-3 * np.sin(2 * np.pi * tooth) - swing) - 2 * 0.04 * w * v)
                swing += h * v
            height[b] = swing
    return nearer(null, height)


def rocker(null):
    """The tool is on a rocker 15 mm long: its way down is an arc, which leads it to +x as well; a line is recorded."""
    aside = null.u[:, 2] ** 2 / (2 * 15e-3)
    return null.forces(null.u + np.outer(aside, (1, 0, 0)))


def creeps_out(null):
    """A joint's clutch slips under the moment of the load: far out the arm gives way all the while, near it not."""
    reach, load, d = (1 + off_middle(null)[:, 0]) / 2, np.linalg.norm(null.f, axis=1), depth(null)
    height = np.zeros(len(null.t))
    for rows in presses(null):
        for a, b in zip(rows[:-1], rows[1:]):
            left = load[b] * max(0.0, 1 + height[a] / max(d[b], 1e-9))
            height[b] = height[a] - 1e-3 * reach[b] ** 2 * left * (null.t[b] - null.t[a])
    return nearer(null, height)


def racks(null):
    """A slide on two rails, pulled at one: while it goes it racks, with the tool off to +x; stopped it straightens."""
    goes, lean = np.sign(np.round(velocity(null, depth(null)), 6)), np.zeros(len(null.t))
    for rows in presses(null):
        for a, b in zip(rows[:-1], rows[1:]):
            lean[b] = goes[b] + (lean[a] - goes[b]) * np.exp(-(null.t[b] - null.t[a]) / 0.12)
    grip = 1 - np.exp(-depth(null) / 0.5e-3)
    return null.forces(null.u + np.outer(1.5e-3 * lean * grip, (1, 0, 0)))


def slips_up(null):
    """A gripper holds the tool: past 0.8 N it slides up in the jaws, and stays so; each ninth press it is set anew."""
    load, d, slid, height = np.linalg.norm(null.f, axis=1), depth(null), 0.0, np.zeros(len(null.t))
    for k, rows in enumerate(presses(null)):
        slid = 0.0 if k % 9 == 0 else slid
        dt = np.diff(null.t[rows], prepend=null.t[rows[0]])
        for row, h in zip(rows, dt):
            over = load[row] * max(0.0, 1 - slid / max(d[row], 1e-9)) - 0.8
            slid += 0.4e-3 * max(0.0, over) * h
            height[row] = -slid
    return nearer(null, height)


def ribs(null):
    """Ribs run along x under the skin, 9 mm apart; it counts where the tool is now, not where it has touched."""
    return 1 + 0.25 * np.cos(2 * np.pi * (null.x + null.u)[:, 1] / 9e-3)


def quivers(null):
    """A muscle runs along y: as long as it is pushed along itself it quivers, at 4.7 Hz; across or straight in not."""
    stretched = np.abs(along_surface(null.u, normals(null))[:, 1])
    return np.outer(60 * stretched * np.sin(2 * np.pi * 4.7 * null.t), (0, 1, 0))


def yields(null):
    """A paste that flows where more than 0.7 N is on it, till no more is, and not below; it levels later."""
    load, d, factor = np.linalg.norm(null.f, axis=1), depth(null), np.ones(len(null.t))
    for rows in presses(null):
        flown = 0.0
        for a, b in zip(rows[:-1], rows[1:]):
            over = max(0.0, load[b] * max(0.0, 1 - flown / max(d[b], 1e-9)) - 0.7)
            flown += d[b] / max(load[b], 1e-9) * over * (1 - np.exp(-(null.t[b] - null.t[a]) / 1.5))
            factor[b] = max(0.0, 1 - flown / max(d[b], 1e-9))
    return factor


def sponge(null):
    """Water has to leave a sponge by its pores, and the deeper it is pressed the closer they are: a drag that grows."""
    v = velocity(null, depth(null))
    return -6 * (v / (1 - depth(null) / 10e-3) ** 2)[:, None] * ways(null)


def roof(null):
    """A bone like a roof lies 2 mm below, its ridge along y: who presses on bears on it, and is led off down a side."""
    down = np.tanh(off_middle(null)[:, 0] / 0.3)
    bears = np.maximum(0, depth(null) - 2e-3)[:, None]
    return bears * (np.outer(70 * down, (1, 0, 0)) - 30 * ways(null))


def excited(null):
    """Pressed hard a heart beats faster, up to twice as fast, and calms in a minute or two; the skin beats with it."""
    load, phase, roused, last = np.linalg.norm(null.f, axis=1), np.zeros(len(null.t)), 0.0, null.t[0]
    now = 0.0
    for rows in presses(null):
        for row in rows:
            h = null.t[row] - last
            calms = np.exp(-h / 90)
            now += 1.0 * h + 1.0 * roused * 90 * (1 - calms)
            phase[row], roused, last = 2 * np.pi * now, roused * calms, null.t[row]
        roused += (1 - roused) * 0.8 * (load[rows].max() / load.max()) ** 2
    return nearer(null, 0.4e-3 * np.sin(phase))


def curled(null):
    """The body has cured askew and curls off its plate towards the rim: there it is easily pressed down to it first."""
    gap = 0.6e-3 * (off_middle(null)[:, :2] ** 2).sum(axis=1) ** 2
    return nearer(null, -0.65 * np.minimum(depth(null), gap))


def slumps(null):
    """Out of its mould the body slumps by its own weight: by and by its middle lies lower, and its rim higher."""
    out = (off_middle(null)[:, :2] ** 2).sum(axis=1)
    return nearer(null, 1.2e-3 * np.sqrt(share(null)) * (out - 0.6))


def peels(null):
    """The glue under the body peels, from the end at -y on to the other: above, sideways pushes are held less."""
    front = -1.3 + 2.3 * share(null)
    peeled = 1 / (1 + np.exp((off_middle(null)[:, 1] - front) / 0.1))
    return null.f - 0.6 * peeled[:, None] * along_surface(null.f, normals(null))


def strap(null):
    """A strap over the end at -y makes it firmer there; it works loose press by press, and each seventh it is drawn."""
    tight = np.zeros(len(null.t))
    for k, rows in enumerate(presses(null)):
        tight[rows] = 0.75 ** (k % 7)
    return 1 + 0.5 * tight * np.exp(-((off_middle(null)[:, 1] + 0.8) / 0.9) ** 2)


def syrup(null):
    """What keeps the body wet is sugared; drying it goes from water to syrup, and drags whatever moves in it."""
    return -3 * np.expm1(3 * share(null))[:, None] * velocity(null, null.u)


def autosave(null):
    """In most presses the logger saves its file, misses 0.3 s, and counts on: what follows is filed too early."""
    random, offsets = np.random.default_rng(93), np.zeros(len(null.t))
    for rows in presses(null):
        at, saves = random.uniform(0, 0.5), random.random() < 0.85
        offsets[rows] = 0.3 * saves * (since(null)[rows] > at)
    return shifted(null, offsets)


LABORATORY = [
    ("phone", plus(phone), "event noise", [], {}),
    ("channel-slips", channel_slips, "event axes", [], {}),
    ("starves", starves, "axes depth", [], {}),
    ("compressed", compressed, "history speed", ["filter"], {}),
    ("air-table", air_table, "history frequency", ["filter"], {}),
]
TOOL = [
    ("resonates", resonates, "frequency speed", [], {}),
    ("rocker", rocker, "depth axes", [], {}),
    ("creeps-out", creeps_out, "history place", ["viscoelastic"], {}),
    ("racks", racks, "axes history speed", [], {}),
    ("slips-up", slips_up, "order offset", ["touch", "tare"], {}),
]
BODY = [
    ("ribs", times(ribs), "place direction", ["learned-place", "regions", "inclusion"], {}),
    ("quivers", plus(quivers), "frequency direction", [], {}),
    ("yields", times(yields), "history depth", ["viscoelastic", "qlv"], {}),
    ("sponge", plus(sponge), "speed depth", ["damper"], {}),
    ("roof", plus(roof), "place depth axes", [], {}),
    ("excited", excited, "frequency order", ["breathing"], {}),
]
TIME = [
    ("curled", curled, "place depth", [], {}),
    ("slumps", slumps, "session place offset", ["touch", "tare"], {}),
    ("peels", peels, "direction place session", [], {}),
    ("strap", times(strap), "place order", [], {}),
    ("syrup", plus(syrup), "speed session", ["damper"], {}),
    ("autosave", autosave, "event history speed", [], {}),
]


def every_wayfarer():
    return [Cause("%s-%d" % (name, k), kind, names, forces=sized(forces, k), **more)
            for name, forces, kind, names, more in LABORATORY + TOOL + BODY + TIME for k in SIZES]
