"""record.py OUT NAME...: the block's surface and the recordings of blocks whose stiffnesses are there: OUT/data/NAME.csv.

The straight boundary as the thesis pressed it: 25 samples a place, straight down to 10 mm, noise of 0.05 N. The curves:
two presses of 25 samples a place, 3 mm straight down and aslant, noise of 1 % of the largest force. With a name's
draws beyond the first (NAME-2) the noise alone is another."""
import pathlib
import sys
import zlib

import numpy as np

import make
import plates
import solve

SAMPLES = 25


def ways(name, k):
    """Full ways of the tool [m] at the place."""
    if name == "straight":
        return [np.array([0, 0, -10e-3])]
    aside = (1.5e-3, 0) if k % 2 else (0, 1.5e-3)
    return [np.array([0, 0, -3e-3]), np.array([*aside, -3e-3])]


def write(out, label):
    name = label.rsplit("-", 1)[0] if label[-1].isdigit() else label
    places, share = plates.places(name), np.arange(1, SAMPLES + 1) / SAMPLES
    random = np.random.default_rng(zlib.crc32(label.encode()))
    presses = []
    for k in range(len(places)):
        K = np.loadtxt(solve.file_of(out, name, k))
        for u in ways(name, k):
            presses.append((k, u, -share[:, None] * (K @ u)))
    noise = 0.05 if name == "straight" else 0.01 * max(np.linalg.norm(f, axis=1).max() for _, _, f in presses)
    lines = ["# object: cuboid", "# tool_radius: %g" % (1e-3 * plates.TOOL), "# force_noise: %.6g" % noise,
             "press,t,x,y,z,ux,uy,uz,fx,fy,fz"]
    for number, (k, u, f) in enumerate(presses):
        f = f + random.normal(0, noise, f.shape)
        for i in range(SAMPLES):
            lines.append("%d,%.2f,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.5f,%.5f,%.5f"
                         % (number, share[i], *(1e-3 * places[k][0]), *(share[i] * u), *f[i]))
    (out / "data" / (label + ".csv")).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    out = pathlib.Path(sys.argv[1])
    (out / "data").mkdir(parents=True, exist_ok=True)
    make.write_bodies(out)
    for label in sys.argv[2:]:
        if not (out / "data" / (label + ".csv")).exists():
            try:
                write(out, label)
            except FileNotFoundError as missing:
                print("%s: skipped, %s has not been computed" % (label, missing.filename), file=sys.stderr)
