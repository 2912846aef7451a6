"""score.py OUT [ASKED]: what hs-identify found in the phantoms (OUT/found/NAME.csv) against what was sealed.

A row a body, then what is asked of all: lumps present or not; sideways, depth, radius and ratio of single lumps; how
often the intervals of 95 % hold. With ASKED, ends with 1 where something asked for is missed."""
import json
import pathlib
import sys

import numpy as np

VISIBLE = 5.0  # standard deviations that a lump's forces must differ by to be asked for
NEAR = 10.0  # what is farther from every lump than this is none of them [mm]


def found_in(path):
    """Rows by column, in mm."""
    lines = [line for line in path.read_text().split("\n") if line and not line.startswith("#")]
    names = lines[0].split(",")
    rows = [dict(zip(names, map(float, line.split(",")))) for line in lines[1:]]
    for row in rows:
        for name in row:
            if name.split("_")[0] in ("x", "y", "z", "depth", "radius"):
                row[name] *= 1e3
    return rows


def sights(path):
    """(radius, ratio, depth) of balls that would have been seen, in mm."""
    rows = [line.split()[2:] for line in path.read_text().split("\n") if line.startswith("# sight:")]
    return [(1e3 * float(r), float(q), 1e3 * float(d)) for r, q, d in rows]


def holds(row, name, value):
    # A cavity's ratio is below what a ratio may be.
    least = 0.05 if name == "ratio" and value == 0 else value
    return row[name + "_low"] <= max(value, least) and value <= row[name + "_high"]


def matched(lumps, rows):
    """Pairs of a lump and the row that is nearest to it, each used once."""
    left, pairs = list(rows), []
    for lump in lumps:
        far = [np.linalg.norm(np.array([r["x"], r["y"], r["z"]]) - lump["centre"]) for r in left]
        if far and min(far) < NEAR:
            pairs.append((lump, left.pop(int(np.argmin(far)))))
        else:
            pairs.append((lump, None))
    return pairs, left


def asked_near(truth):
    """A single lump of 12 mm whose top is down to 10 mm deep."""
    lump = truth["lumps"][0]
    return len(truth["lumps"]) == 1 and lump["radius"] == 6 and lump["depth"] - lump["radius"] <= 10


def main(out, asked):
    print("%-9s %-7s %6s %5s %8s  %-6s %6s %6s | %5s %8s %8s %8s %7s %s" % (
        "body", "shape", "places", "noise", "sigma", "lump", "radius", "ratio", "found", "sideways", "depth", "off",
        "radius", "ratio  in 95 %"))
    right = wrong = false = empty = 0
    held, of = {n: 0 for n in ("x", "y", "z", "depth", "radius", "ratio")}, 0
    near = []
    for sealed in sorted((out / "sealed").glob("*.json")):
        path = out / "found" / (sealed.stem + ".csv")
        if not path.exists():
            continue
        truth, rows = json.loads(sealed.read_text()), found_in(path)
        pairs, left = matched(truth["lumps"], rows)
        false += len(left)
        head = "%-9s %-7s %6d %4.0f%% %8.1f" % (sealed.stem, truth["body"], truth["places"], 100 * truth["noise"], truth["sigma"])
        if not truth["lumps"]:
            empty += 1
            print(head + "  none%s" % (": %d FALSE" % len(rows) if rows else ""))
        visible = truth["sigma"] > VISIBLE
        for lump, row in pairs:
            told = "%-6s %6.1f %6.2f" % (lump["kind"], lump["radius"], lump["ratio"])
            if row is None:
                print(head + "  " + told + " | %s at %.1f mm" % ("MISSED" if visible else "not visible", lump["depth"]))
                continue
            at = np.array([row["x"], row["y"], row["z"]])
            off = at - lump["centre"]
            sideways = np.hypot(*off[:2])
            inside = [n for n in held if holds(row, n, dict(zip("xyz", lump["centre"]), **lump)[n])]
            for n in inside:
                held[n] += 1
            of += 1
            if asked_near(truth):
                near.append((sideways, abs(row["depth"] - lump["depth"])))
            print(head + "  " + told + " | %5s %8.2f %8.2f %+8.2f %7.2f %5.2f  %s" % (
                "yes", sideways, row["depth"], row["depth"] - lump["depth"], row["radius"], row["ratio"],
                "all" if len(inside) == 6 else "not " + " ".join(n for n in held if n not in inside)))
        if truth["lumps"] and visible:
            right += all(row is not None for _, row in pairs) and not left
            wrong += not (all(row is not None for _, row in pairs) and not left)
    print()
    near = np.array(near).reshape(-1, 2)
    good = int(np.sum(np.all(near <= 2, axis=1)))
    print("visible lumps (above %g sigma) all found and no other: %d of %d" % (VISIBLE, right, right + wrong))
    print("false lumps: %d, of %d empty bodies and all others" % (false, empty))
    print("single lumps of 12 mm down to 10 mm: centre sideways and depth within 2 mm in %d of %d; rms %.2f and %.2f mm"
          % (good, len(near), *(np.sqrt(np.mean(near**2, axis=0)) if len(near) else (0, 0))))
    print("intervals of 95 %% hold: %s; %d of %d" % (
        ", ".join("%s %d" % item for item in held.items()), sum(held.values()), 6 * of))
    return asked and (wrong > 0 or false > 0 or good < len(near))


if __name__ == "__main__":
    sys.exit(int(main(pathlib.Path(sys.argv[1]), len(sys.argv) > 2)))
