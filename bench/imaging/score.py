"""score.py OUT NUMBER LENGTH SPREAD: of image-NUMBER.ply the share of tetrahedra whose true log modulus lies within
the image's 95 %, of all and of those that the image tells within a factor of 2."""
import sys

import numpy as np

from draw import Field, read_body

FACTOR2 = np.log(2) / 1.959963985


def main():
    out, number, length, spread = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4])
    data, _, nodes, tets = read_body(f"{out}/image-{number}.ply")
    middle = nodes[tets["v"]].mean(axis=1)
    truth = np.log(1e4) + Field(number, length, spread)(middle)
    off = np.abs(np.log(tets["E"]) - truth) / tets["log_E_std"]
    told = tets["log_E_std"] < FACTOR2
    model = float(data[:2000].split(b"comment model_modulus ")[1].split(b"\n")[0])
    differs = np.abs(np.log(tets["E"] / model)) > 1.959963985 * tets["log_E_std"]
    share = lambda within, of: f"{100 * within[of].mean():.1f} %" if of.any() else "-"
    deep = 0.04 - middle[:, 2]
    by_depth = " ".join(share(off < 1.96, told & (deep >= a) & (deep < a + 0.01)) for a in (0, 0.01, 0.02))
    print(f"body {number:3d}: {len(tets)} tetrahedra, within 95 %: all {share(off < 1.96, off >= 0)}, told within a factor of 2 "
          f"({share(told, off >= 0)}) {share(off < 1.96, told)}, by depth to 10, 20, 30 mm {by_depth}; "
          f"said to differ {share(differs, off >= 0)}, on the right side of these "
          f"{share((np.log(tets['E'] / model) * (truth - np.log(model)) > 0), differs)}")


if __name__ == "__main__":
    main()
