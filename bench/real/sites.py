"""sites.py BIN DATA BODY OUT [FOLDS [MODEL...]]: hapsim against plain maps on places that neither has seen.

Places of the recording DATA are left out in FOLDS parts (10, places dealt out in turn). Each MODEL is the flags by
which BIN/hs-identify makes it from the other places on BODY ("--effects hyperelastic --add regions --regions sites");
BIN/hs-simulate then foretells those left out. BIN - compares the maps alone. The maps carry a stiffness (or two
numbers: of the depth and its square) from place to place by inverse distances to a power, on the same folds. All
errors along each press's direction, root mean squares in mN. Prints a row a method: its error, that over the best
map's with power 4, and seconds. OUT keeps the files; stiffnesses at the places are prepared once, in OUT/cache.
"""
import os
import subprocess
import sys
import time

import numpy as np


def table(path):
    lines = [l.rstrip("\n") for l in open(path)]
    meta = [l for l in lines if l.startswith("#")]
    rows = [l for l in lines if l and not l.startswith("#")]
    head = rows[0].split(",")
    data = np.array([[float(x) if x else np.nan for x in r.split(",")[: len(head)]] for r in rows[1:]])
    return meta, rows[0], rows[1:], head, data


def columns(head, data, *names):
    return np.stack([data[:, head.index(n)] for n in names], 1)


class Recording:
    def __init__(self, path):
        self.meta, self.header, self.rows, head, data = table(path)
        self.press = data[:, head.index("press")].astype(int)
        self.force = columns(head, data, "fx", "fy", "fz")
        place = columns(head, data, "x", "y", "z")
        motion = columns(head, data, "ux", "uy", "uz")
        self.sites = []  # places in order of their first press
        self.site = np.zeros(len(self.press), int)
        self.normal = np.zeros_like(self.force)
        for p in dict.fromkeys(self.press):
            rows = self.press == p
            at = place[rows][0]
            near = [k for k, s in enumerate(self.sites) if np.linalg.norm(s - at) <= 1e-4]
            if not near:
                near = [len(self.sites)]
                self.sites.append(at)
            self.site[rows] = near[0]
            deepest = motion[rows][np.argmax(np.linalg.norm(motion[rows], axis=1))]
            self.normal[rows] = -deepest / np.linalg.norm(deepest)
        self.sites = np.array(self.sites)
        self.depth = -(motion * self.normal).sum(1) * 1e3
        self.along = (self.force * self.normal).sum(1) * 1e3

    def write(self, path, rows):
        with open(path, "w") as out:
            out.write("\n".join(self.meta + [self.header] + [self.rows[i] for i in np.flatnonzero(rows)]) + "\n")


def rms(x):
    return float(np.sqrt(np.mean(x * x)))


def by_map(r, fold, folds, powers, distance_power):
    """Coefficients of the powers of the depth at each site, interpolated."""
    coefficients = np.array(
        [
            np.linalg.lstsq(np.stack([r.depth[r.site == s] ** q for q in powers], 1), r.along[r.site == s], rcond=None)[0]
            for s in range(len(r.sites))
        ]
    )
    error = np.zeros_like(r.along)
    for f in range(folds):
        known = fold != f
        for s in np.flatnonzero(~known):
            weight = 1 / np.maximum(np.linalg.norm(r.sites[known] - r.sites[s], axis=1), 1e-9) ** distance_power
            c = weight @ coefficients[known] / weight.sum()
            rows = r.site == s
            error[rows] = r.along[rows] - sum(c[k] * r.depth[rows] ** q for k, q in enumerate(powers))
    return rms(error)


def by_model(r, fold, folds, model, number, binaries, body, out):
    error = np.full_like(r.along, np.nan)
    flags = ["--body", body, "--cache", os.path.join(out, "cache")]
    for f in range(folds):
        left_out = fold[r.site] == f
        files = {k: os.path.join(out, f"{number}-{f}-{k}.csv") for k in ("seen", "unseen", "model", "forces")}
        r.write(files["seen"], ~left_out)
        r.write(files["unseen"], left_out)
        run = lambda tool, *a: subprocess.run([os.path.join(binaries, tool), *a], check=True, capture_output=True)
        run("hs-identify", files["seen"], *flags, *model.split(), "--fix", "nu=0.45", "--folds", "0", "-o", files["model"])
        run("hs-simulate", files["unseen"], *flags, "--model", files["model"], "-o", files["forces"])
        _, _, _, head, data = table(files["forces"])
        simulated = columns(head, data, "fx", "fy", "fz")
        error[left_out] = r.along[left_out] - 1e3 * (simulated * r.normal[left_out]).sum(1)
    return rms(error)


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    binaries, recording, body, out = sys.argv[1:5]
    folds = int(sys.argv[5]) if len(sys.argv) > 5 else 10
    models = sys.argv[6:] or ["--effects elastic", "--effects hyperelastic --add regions --regions sites"]
    os.makedirs(out, exist_ok=True)
    r = Recording(recording)
    fold = np.arange(len(r.sites)) % folds
    print(f"{len(r.sites)} places, {len(r.along)} rows, {folds} folds, force {rms(r.along):.1f} mN rms along the press")
    print("method,error_mN,of_best_map,seconds")
    best = np.inf
    for powers, words in (((1,), "one number a place"), ((1, 2), "two numbers a place")):
        for distance_power in (2, 3, 4):
            e = by_map(r, fold, folds, powers, distance_power)
            if distance_power == 4:
                best = min(best, e)
            print(f"map of {words}; distance to the power {distance_power},{e:.2f},,")
    for number, model in enumerate(models if binaries != "-" else []):
        begin = time.time()
        try:
            e = by_model(r, fold, folds, model, number, binaries, body, out)
            print(f'"{model}",{e:.2f},{e / best:.3f},{time.time() - begin:.0f}', flush=True)
        except subprocess.CalledProcessError as error:
            print(f'"{model}",failed: {error.stderr.decode()[-200:].strip()},,', flush=True)


main()
