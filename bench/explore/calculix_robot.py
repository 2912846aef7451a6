"""calculix_robot.py OUT BODY MOTION: a robot that presses a body of two regions (`regions` of bench/independent) solved by
CalculiX on a mesh of Gmsh's for each place, and prints the motion's rows with forces; the tool sticks, NOISE [N] is
added (seed SEED). OUT/stiffness keeps what was solved. Bodies: cuboid, ball, organ, as their STL (make.py) has them."""
import os
import pathlib
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "independent"))
import bodies  # noqa: E402
import calculix  # noqa: E402
import meshes  # noqa: E402
import variants  # noqa: E402

TOOL = 4.0
# Elements follow the boundary by their centroids: of the block's, whose formula Gmsh can read, they are small near it.
NEAR = {"cuboid": "1.5+0.3*abs(x-62-14*sin(0.05*y+1))"}


def exact_place(body, p):
    """The nearest place of the exact surface, about, and its normal [mm]."""
    if body == "cuboid":
        return np.array([p[0], p[1], bodies.CUBOID[2]]), np.array([0.0, 0.0, 1.0])
    if body == "ball":
        return bodies.on_ball(p - bodies.BALL_MIDDLE)
    return bodies.on_organ(p - bodies.ORGAN_MIDDLE)


def stiffness(out, body, p):
    """Of the tool at that place [N/m]."""
    target = out / "stiffness" / ("loop-%s" % body) / ("%.2f_%.2f_%.2f.txt" % tuple(p))
    if not target.exists():
        with tempfile.TemporaryDirectory(prefix="hapsim-robot-") as folder:
            folder = pathlib.Path(folder)
            place = exact_place(body, p)
            mesh = meshes.Mesh(body, place, TOOL, folder, (place[0], 1, 14), growth=0.3, more=NEAR.get(body, ""),
                               quarter_points=True)
            K = calculix.stiffness(folder, mesh, *variants.build("regions", body, mesh))
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_suffix(".part")
        np.savetxt(part, K)
        part.rename(target)
    return np.loadtxt(target)


def main():
    out, body, motion = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    lines = [line.rstrip("\n") for line in open(motion)]
    table = [line for line in lines if line and not line.startswith("#")]
    names = table[0].split(",")
    rows = [line.split(",") for line in table[1:]]
    random = np.random.default_rng(int(os.environ.get("SEED", "11")) + (int(rows[0][0]) if rows else 0))
    noise = float(os.environ.get("NOISE", "0.01"))
    for line in lines:
        if line.startswith("# tool"):
            print(line)
    print("# force_noise: %g" % noise)
    print(",".join(names + ["fx", "fy", "fz"]))
    for row in rows:
        value = dict(zip(names, row))
        u = np.array([float(value[c]) for c in ("ux", "uy", "uz")])
        f = np.zeros(3)
        if value["contact"] == "1":
            f = -stiffness(out, body, 1e3 * np.array([float(value[c]) for c in "xyz"])) @ u
        print(",".join(row + ["%.5f" % v for v in f + random.normal(0, noise, 3)]))


if __name__ == "__main__":
    main()
