"""lumps.py SET...: the table of lumps.sh, from SET.csv (a recording) and SET.lumps.csv in this folder. Each ball's
"peak" is the middle of the sites near it, weighted by what their stiffness is above twice the median."""
import csv
import sys

import numpy as np

NEAR = 9.0  # sites so near to a ball tell its peak [mm]


def rows_of(path):
    with open(path) as file:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(l for l in file if not l.startswith("#"))]


def sites(path):
    """Points (n, 2) in plan view [mm] and stiffness along the way of the tool (n) [N/m]."""
    by_press = {}
    for row in rows_of(path):
        by_press.setdefault(row["press"], []).append([row[k] for k in ("x", "y", "ux", "uy", "uz", "fx", "fy", "fz")])
    points, stiffness = [], []
    for rows in map(np.array, by_press.values()):
        way = rows[-1, 2:5] / np.linalg.norm(rows[-1, 2:5])
        points.append(1e3 * rows[0, :2])
        stiffness.append(-np.polyfit(rows[:, 2:5] @ way, rows[:, 5:] @ way, 1)[0])
    return np.array(points), np.array(stiffness)


points, stiffness = sites(sys.argv[1] + ".csv")
above = np.clip(stiffness - 2 * np.median(stiffness), 0, None)
print("%-6s %5s %7s %7s %9s | %6s %13s | %6s %13s | %6s %13s" % (
    "sites", "ball", "x", "y", "off peak", "depth", "95 %", "radius", "95 %", "ratio", "95 %"))
for name in sys.argv[1:]:
    for k, row in enumerate(sorted(rows_of(name + ".lumps.csv"), key=lambda r: r["y"])):
        at = np.array([1e3 * row["x"], 1e3 * row["y"]])
        near = np.linalg.norm(points - at, axis=1) < NEAR
        peak = (above[near, None] * points[near]).sum(axis=0) / max(above[near].sum(), 1e-9)
        told = ["%6.2f %6.2f %6.2f" % tuple(f * row[n + e] for e in ("", "_low", "_high"))
                for n, f in (("depth", 1e3), ("radius", 1e3), ("ratio", 1))]
        print("%-6s %5d %7.2f %7.2f %9.2f | %s" % (name, k + 1, *at, np.linalg.norm(at - peak), " | ".join(told)))
