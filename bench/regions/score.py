"""score.py OUT FOLDER NAME...: the models OUT/FOLDER/NAME-added.csv and -refined.csv against what CalculiX was given.

Moduli as they are; the boundary over the pressed area (the box of the places): root mean square of the distances of the
true curve from the found one, or of the found one from the true one, whichever is larger; and how much of the true curve is within
the model's own 95 % of the found one (the key points' standard errors, twice)."""
import csv
import pathlib
import sys

import numpy as np

import plates
import variants

STEP = 0.25  # [mm] of the grid on which curves are looked for


def model_of(path):
    """Moduli [Pa], key points [mm] with regions and standard errors across the boundary [mm] (nan: none told)."""
    moduli, points = {}, {}
    with open(path) as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["effect"] == "elastic" and row["parameter"] == "E":
                moduli[int(row["region"] or 0)] = (float(row["value"]), float(row["std_error"] or "nan"))
            if row["effect"] == "regions" and row["parameter"] != "local":
                key = points.setdefault((int(row["region"]), row["parameter"][1:]), {})
                key[row["parameter"][0]] = 1e3 * float(row["value"])
                key[row["parameter"][0] + "_error"] = 1e3 * float(row.get("std_error") or "nan")
    return moduli, points


def crossings(values, x, y):
    """Points of the grid's edges where `values` (len(x), len(y)) change."""
    across, along = np.nonzero(values[1:] != values[:-1]), np.nonzero(values[:, 1:] != values[:, :-1])
    return np.vstack([np.column_stack([(x[across[0]] + x[across[0] + 1]) / 2, y[across[1]]]),
                      np.column_stack([x[along[0]], (y[along[1]] + y[along[1] + 1]) / 2])])


def nearest(a, b):
    """Distances of each of a (n, 2) from the nearest of b, and which that is."""
    d = np.sqrt(((a[:, None] - b[None]) ** 2).sum(axis=2))
    return d.min(axis=1), d.argmin(axis=1)


def score(path, name):
    moduli, points = model_of(path)
    places = np.array([p[:2] for p, _ in plates.places(name)])
    low, high = places.min(axis=0), places.max(axis=0)
    x, y = (np.arange(low[k], high[k] + STEP, STEP) for k in (0, 1))
    X, Y = np.meshgrid(x, y, indexing="ij")
    truth = crossings(variants.TWO_PARTS[name][0](X, Y) > 0, x, y)
    if not points:
        return "%d region, no boundary" % len(moduli)
    keys = np.array([[p["x"], p["y"]] for p in points.values()])
    region = np.array([key[0] for key in points])
    error = np.array([np.hypot(p["x_error"], p["y_error"]) for p in points.values()])
    _, k = nearest(np.column_stack([X.ravel(), Y.ravel()]), keys)
    found = crossings(region[k].reshape(X.shape), x, y)
    used = sorted(set(region[k]))
    E = [moduli[r] for r in used]
    words = "%d regions: %s kPa (true %s)" % (
        len(used), ", ".join("%.2f +- %.2f" % (e / 1e3, s / 1e3) for e, s in E), ", ".join("%g" % (e / 1e3) for e in plates.moduli(name)))
    if not len(found):
        return words + "; no boundary in the pressed area"
    off, at = nearest(truth, found)
    back, _ = nearest(found, truth)
    rms = max(np.sqrt(np.mean(off**2)), np.sqrt(np.mean(back**2)))
    words += "; boundary %.2f mm rms, %.2f at most" % (rms, max(off.max(), back.max()))
    told = error[nearest(found[at], keys)[1]]
    if np.isfinite(told).all():
        words += "; told +- %.2f mm (1 sigma, rms), within twice in %.0f %%" % (np.sqrt(np.mean(told**2)), 100 * np.mean(off < 2 * told))
    return words


if __name__ == "__main__":
    out = pathlib.Path(sys.argv[1]) / sys.argv[2]
    for label in sys.argv[3:]:
        name = label.rsplit("-", 1)[0] if label[-1].isdigit() else label
        for stage in ("added", "refined"):
            path = out / ("%s-%s.csv" % (label, stage))
            if path.exists():
                print("%-10s %-8s %s" % (label, stage, score(path, name)), flush=True)
