"""small_score.py BIN OUT [SHAPE...]: forces above thin and small regions beside CalculiX's (small.py), of the region as the
body's label and, of spheres, as the effect inclusion; and under skins, as the effect layer. Recorded in bench/results/regions-small.txt.

Columns: normal stiffness, % off; the stiffness in the direction in which it is furthest off; of all of it (Frobenius); what the
region changes of the normal one, %; what hs-simulate warns of, which is of the direction in which mixtures do most."""
import csv
import pathlib
import subprocess
import sys

import numpy as np

import closed
import make
import small


def model(path, ratio, kind="label", shape=None):
    """`shape`: the ball of an inclusion, the thickness [mm] of a layer."""
    rows = ["effect,region,parameter,value,state", "elastic,0,E,%g,free" % closed.MODULUS,
            "elastic,0,nu,%g,fixed" % closed.POISSON]
    if kind == "label":
        rows.insert(2, "elastic,1,E,%g,free" % (ratio * closed.MODULUS))
    elif kind == "inclusion":
        values = dict(zip("xyz", 1e-3 * shape.middle), radius=1e-3 * shape.radius, ratio=ratio)
        rows += ["inclusion,0,%s,%g,free" % row for row in values.items()]
    else:
        rows += ["layer,0,thickness,%g,free" % (1e-3 * shape), "layer,0,ratio,%g,free" % ratio]
    path.write_text("\n".join(rows) + "\n")


def stiffness(path):
    rows = list(csv.DictReader(line for line in open(path) if not line.startswith("#")))
    f = np.array([[float(row[c]) for c in ("fx", "fy", "fz")] for row in rows])
    return -f.T / 1e-3


def simulate(binaries, motion, body, model_file, out):
    done = subprocess.run([binaries + "/hs-simulate", motion, "--body", body, "--model", model_file, "-o", out],
                          capture_output=True, text=True)
    if done.returncode != 0:
        return None, done.stderr.strip()
    said = [line.split(", by ")[1] for line in done.stderr.split("\n") if "cut elements" in line]
    return stiffness(out), " ".join(said)


def correction(mine, even, truth):
    """CalculiX's `truth` less what its mesh errs with equal moduli, where hapsim has `mine`: the map that takes one to the other."""
    S = np.linalg.cholesky(mine) @ np.linalg.inv(np.linalg.cholesky(even))
    return S @ truth @ S.T


def worst(mine, truth):
    """The relative error of u' K u in the direction u in which it is largest."""
    L = np.linalg.inv(np.linalg.cholesky(truth))
    off = np.linalg.eigvalsh(L @ (mine + mine.T) / 2 @ L.T) - 1
    return off[np.argmax(np.abs(off))]


def main():
    binaries, out = sys.argv[1], pathlib.Path(sys.argv[2])
    folder = out / "small"
    folder.mkdir(parents=True, exist_ok=True)
    make.write_bodies(out)
    motion = folder / "motion.csv"
    x, y = small.PLACES[0]
    motion.write_text("# tool_radius: %g\npress,x,y,z,ux,uy,uz\n" % (1e-3 * closed.TOOL) + "".join(
        "%d,%.9g,%.9g,0.06,%g,%g,%g\n" % (k, 1e-3 * x, 1e-3 * y, *(1e-3 * np.eye(3)[k])) for k in range(3)))
    print("%-11s %-10s %6s %8s %8s %8s %9s  %s" % ("shape", "as", "ratio", "normal", "worst", "all", "changes", "said"))
    uniform = None
    for name in sys.argv[3:] or [*small.SHAPES, *small.SKINS]:
        body = folder / (name + ".ply")
        if name in small.SKINS:
            body, (shape, ratios) = folder / "sheet-2.ply", small.SKINS[name]
        else:
            shape, _, ratios = small.SHAPES[name]
        if not body.exists():
            small.write_surface(out, body.stem)
            subprocess.run([binaries + "/hs-tetmesh", "-q", out / "cuboid.stl", "--region", body.with_suffix(".stl"), "-o", body],
                           check=True)
        file = folder / "model.csv"
        if uniform is None:
            model(file, 1)
            uniform, _ = simulate(binaries, motion, body, file, folder / "forces.csv")
        for ratio in ratios:
            truth = small.file_of(out, name, 0, ratio)
            if not truth.exists():
                continue
            truth = correction(uniform, np.loadtxt(small.file_of(out, name, 0, 1)), np.loadtxt(truth))
            kinds = ["layer"] if name in small.SKINS else ["label"]
            if isinstance(shape, closed.Ball) and 0.02 <= ratio <= 50:
                kinds.append("inclusion")
            for kind in kinds:
                model(file, ratio, kind, shape)
                K, said = simulate(binaries, motion, body, file, folder / "forces.csv")
                if K is None:
                    print("%-11s %-10s %6g %s" % (name, kind, ratio, said), flush=True)
                    continue
                print("%-11s %-10s %6g %+8.2f %+8.2f %8.2f %+9.1f  %s" % (
                    name, kind, ratio, 100 * (K[2, 2] / truth[2, 2] - 1), 100 * worst(K, truth), 100 * np.linalg.norm(K - truth) / np.linalg.norm(truth),
                    100 * (truth[2, 2] / uniform[2, 2] - 1), said), flush=True)


if __name__ == "__main__":
    main()
