"""closed_score.py OUT CASE LABEL=FORCES...: by place, how far forces are off CalculiX's: of the normal stiffness, and of all
of it (Frobenius); and what the regions change of it (of the case whose equal moduli were solved)."""
import csv
import sys

import numpy as np

import closed


def stiffnesses(name, path):
    rows = [row for row in csv.DictReader(line for line in open(path) if not line.startswith("#"))]
    f = np.array([[float(row[c]) for c in ("fx", "fy", "fz")] for row in rows]).reshape(-1, 3, 3)
    return -f.transpose(0, 2, 1) / 1e-3  # K[:, axis] is the force against a move along it


def normal(K, n):
    return n @ K @ n


out, name = sys.argv[1:3]
for text in sys.argv[3:]:
    label, path = text.split("=", 1)
    off, off_all, words = [], [], []
    for k, ((_, n), K) in enumerate(zip(closed.places(name), stiffnesses(name, path))):
        if not closed.file_of(out, name, k).exists():  # not solved yet
            words.append("-")
            continue
        truth = np.loadtxt(closed.file_of(out, name, k))
        off.append(100 * (normal(K, n) / normal(truth, n) - 1))
        off_all.append(100 * np.linalg.norm(K - truth) / np.linalg.norm(truth))
        even = closed.file_of(out, name, k, ".even")
        words.append("%+.2f" % off[-1] + (" (%+.0f)" % (100 * (normal(truth, n) / normal(np.loadtxt(even), n) - 1))
                                          if even.exists() else ""))
    print("%-13s %-9s normal %% off (and what the regions change): %s; worst %.2f, of all of K %.2f"
          % (name, label, ", ".join(words) if len(words) < 6 else "%d places" % len(words), np.abs(off).max(), max(off_all)))
