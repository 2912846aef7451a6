"""curves.py BIN SOLVED OUT DRAWS NULL=BODY... [KIND...]: whether a learned curve is the truth, within its band.

Each draw gives a recording of a linear body (NULL, as of worlds.py, SOLVED: its stiffnesses by CalculiX and its mesh,
the folder OUT of run.sh) a law that is drawn by its number, of four times the noise, and hs-identify learns it with the
curve over the same thing: factors over the depth, gains and zeros over the session, gains of the force along z and
across it (sums of three waves), memories (one to three exponential terms, of three at times one against the others, or
a power of time). By kind of curve: draws; points inside the band of 95 %, of all that hs-identify writes; draws with 90
% of their points inside; of the error at unseen positions, over what the elastic model leaves there of the same
recording without the law, the median, the worst, and draws where it is at most 1.5. PYTHONPATH: bench/independent.
Recorded in bench/results/learned-curves.txt."""
import csv
import pathlib
import statistics
import subprocess
import sys

import numpy as np

from causes import presses
from strangers import share
from visitors import normals
from worlds import Null, save

SIZE = 4  # times the noise


def waves(random):
    """A smooth law over 0 to 1, of largest value about 1."""
    a, phase = random.normal(size=3) / (1, 1, 2), random.uniform(0, 2 * np.pi, 3)
    return lambda x: sum(a[k] * np.sin(np.pi * (k + 1) * np.asarray(x) + phase[k]) for k in range(3)) / 1.5


def own(change, null):
    """Root mean square of what changes, less what a common gain would."""
    left = change - null.f * (change * null.f).sum() / (null.f ** 2).sum()
    return np.sqrt((left ** 2).mean())


def largest(change, null, most=8.0):
    """The number at which change(number) is SIZE times the noise."""
    low, high = 0.0, most
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if own(change(middle), null) < SIZE * null.noise else (low, middle)
    return low


def by_depth(null, random):
    law, d = waves(random), -(null.u * normals(null)).sum(axis=1)
    most = d.max()
    change = lambda a: null.f * np.expm1(a * (law(d / most) - law(1)))[:, None]
    a = largest(change, null)
    return change(a), {"factor": lambda x: np.exp(a * (law(x / most) - law(1)))}


def by_gain(null, random):
    law, span = waves(random), null.t[-1] - null.t[0]
    change = lambda a: null.f * np.expm1(a * (law(share(null)) - law(0)))[:, None]
    a = largest(change, null)
    return change(a), {"gain": lambda x: np.exp(a * (law(x / span) - law(0)))}


def by_drift(null, random):
    laws, span = [waves(random) for _ in range(3)], null.t[-1] - null.t[0]
    change = np.stack([law(share(null)) for law in laws], axis=1)
    a = SIZE * null.noise / own(change, null)
    return a * change, {"zero " + axis: lambda x, law=law: a * law(x / span) for axis, law in zip("xyz", laws)}


def readings(law, over_force):
    """Forces and what they are read as, in shares of the largest; the gain's logarithm is law(force), or law(reading).
    None where a larger force reads less."""
    grid = np.linspace(0, 3, 3001)
    gain = np.exp(law(np.minimum(grid, 1)))
    force, read = (grid, grid * gain) if over_force else (grid / gain, grid)
    return (force, read) if min(np.diff(force).min(), np.diff(read).min()) > 0 else None


def by_axes(null, random):
    """Every other draw's gains go by the force, not by what is read, as the effect has it."""
    size, z, over_force = np.linalg.norm(null.f[:, :2], axis=1), np.abs(null.f[:, 2]), random.uniform() < 0.5
    sa, sz = size.max(), z.max()
    while True:  # until both are curves of what is read
        across, along = waves(random), waves(random)

        def tables(a):
            return readings(lambda r: a * across(r), over_force), readings(lambda r: a * (along(r) - along(1)), over_force)

        def change(a):
            (xa, ya), (xz, yz) = tables(a)
            times = [sa * np.interp(size / sa, xa, ya) / np.maximum(size, 1e-12)] * 2
            times.append(sz * np.interp(z / sz, xz, yz) / np.maximum(z, 1e-12))
            return null.f * (np.where(null.f == 0, 1, np.stack(times, axis=1)) - 1)

        good = [a for a in np.linspace(0, 2, 201)[1:] if all(tables(a))]
        if good and own(change(good[-1]), null) > SIZE * null.noise:
            break
    a = largest(change, null, good[-1])
    (xa, ya), (xz, yz) = tables(a)

    def gain(span, x, y):
        return lambda read: np.exp(np.interp(read / span, y[1:], np.log(y[1:] / x[1:])))

    return change(a), {"gain across z": gain(sa, xa, ya), "gain along z": gain(sz, xz, yz)}


def by_memory(null, random):
    if random.uniform() < 0.25:
        power, short = random.uniform(0.1, 0.5), 0.05
        kernel = lambda t: (1 + np.asarray(t) / short) ** -power
    else:
        count = random.integers(1, 4)
        g, tau = random.uniform(0.3, 1, count), np.exp(random.uniform(np.log(0.08), np.log(3), count))
        if count == 3 and random.uniform() < 0.5:
            g[0] *= -0.5
        kernel = lambda t: (g * np.exp(-np.asarray(t)[..., None] / tau)).sum(axis=-1)
    change = np.zeros_like(null.f)
    for rows in presses(null):
        t, steps = null.t[rows], np.diff(null.f[rows], axis=0, prepend=0 * null.f[rows[:1]])
        for k in range(1, len(rows)):  # each step is made evenly from one sample to the next
            for part in (np.arange(8) + 0.5) / 8:
                began = t[k - 1] + part * (t[k] - t[k - 1])
                since = t[k:] - began
                change[rows[k:]] += np.outer(np.where(since > 0, kernel(np.maximum(since, 0)), 0), steps[k] / 8)
    a = SIZE * null.noise / own(change, null)
    return a * change, {"share": lambda x: a * kernel(x)}


KINDS = {"learned-depth": by_depth, "learned-kernel": by_memory, "learned-gain": by_gain, "learned-drift": by_drift,
         "learned-axes": by_axes}


def unseen(model):
    """Error at positions left out [N]."""
    return next(float(line.split(":")[1]) for line in model.read_text().splitlines() if line.startswith("# heldout:"))


def identify(binary, data, body, effects, model, *more):
    subprocess.run([str(binary / "hs-identify"), "-q", str(data), "--body", str(body), "--effects", effects, "-o", str(model)] +
                   list(more), check=True)


def inside(curves, truth):
    """Of the points that the truth has: whether each is in its band; without a band it is not. Of a factor, and of one plus
    a memory, the modulus may take a part: truths are told over the one by which they come nearest."""
    points = [p for p in csv.DictReader(curves.open()) if p["curve"] in truth]
    low, high = (np.array([float(p[side] or "nan") for p in points]) for side in ("low", "high"))
    middle, half = (high + low) / 2, np.maximum((high - low) / 2, 1e-3)
    told = np.array([truth[p["curve"]](float(p["x"])) for p in points])
    if points[0]["y_unit"] == "1":
        one = 1 if points[0]["curve"] == "share" else 0
        part = min(np.geomspace(0.6, 1.7, 1200), key=lambda c: np.nansum((((one + told) / c - one - middle) / half) ** 2))
        told = (one + told) / part - one
    return [bool(within) for within in (told >= low) & (told <= high)]


if __name__ == "__main__":
    binary, solved, out, draws, *rest = sys.argv[1:]
    binary, solved, out = (pathlib.Path(path) for path in (binary, solved, out))
    nulls = [(Null(path, solved, body), body) for path, body in (r.split("=") for r in rest if "=" in r)]
    kinds = [r for r in rest if "=" not in r] or list(KINDS)
    print("%-15s %5s %16s %14s   %s" % ("curve", "draws", "points inside", "draws >= 90 %", "unseen over the floor: median, worst, within 1.5"))
    for kind in kinds:
        shares, points, ratios = [], [], []
        for draw in range(int(draws)):
            null, body = nulls[draw % len(nulls)]
            random = np.random.default_rng([draw, *kind.encode()])
            change, truth = KINDS[kind](null, random)
            noise = random.normal(0, null.noise, null.f.shape)
            ply = solved / (body + "-stl.ply")
            for name, f, effects, more in (("plain", null.f + noise, "elastic", []),
                                           ("hidden", null.f + change + noise, "elastic," + kind, ["--curves", str(out / "curve.csv")])):
                save(out / (name + ".csv"), null, null.head, null.u, f)
                identify(binary, out / (name + ".csv"), ply, effects, out / (name + "-model.csv"), *more)
            found = inside(out / "curve.csv", truth)
            points += found
            shares.append(float(np.mean(found)))
            ratios.append(unseen(out / "hidden-model.csv") / unseen(out / "plain-model.csv"))
            print(kind, draw, body, "%.3f %.3f" % (shares[-1], ratios[-1]), file=sys.stderr)
        print("%-15s %5d %7d %6.1f %% %11d     %.2f, %.2f, %d" %
              (kind, len(shares), len(points), 100 * np.mean(points), sum(s >= 0.9 for s in shares),
               statistics.median(ratios), max(ratios), sum(r <= 1.5 for r in ratios)), flush=True)
