"""markers.py BIN [RADIUS]: how points of the surface move with the tool, by CalculiX and by hs-simulate --markers.

CalculiX: second-order tetrahedra of Gmsh's, displacements of nodes of the free surface from 1.1 to 6 radii off
the contact, for unit moves of the patch along each axis; on a cuboid in the middle, near an edge and in a corner,
on a ball and on an organ, for two Poisson's ratios. Minutes."""
import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import calculix
import meshes
from torques import CASES, MODULUS, body_of, place_of

SEEN = 40  # points a place


def seen_nodes(mesh, point, radius):
    """Corners of the free surface, spread over the logarithm of their distance."""
    corners = np.unique(meshes.boundary_faces(mesh.tets)[:, :3])
    corners = np.setdiff1d(corners, np.concatenate([mesh.patch, mesh.bottom]))
    far = np.linalg.norm(mesh.nodes[corners] - point, axis=1)
    order = corners[np.argsort(far)]
    far = np.sort(far)
    order = order[(far > 1.1 * radius) & (far < 6 * radius)]
    far = np.log(far[(far > 1.1 * radius) & (far < 6 * radius)])
    wanted = np.linspace(far[0], far[-1], SEEN)
    return np.unique(order[np.minimum(np.searchsorted(far, wanted), len(order) - 1)])


def by_calculix(folder, mesh, materials, seen):
    """Gains (points, 3, 3): displacement by axis of the tool's."""
    text = calculix.deck(mesh, materials, mesh.bottom)
    text += "*NSET, NSET=SEEN\n%s\n" % calculix.number_list(seen + 1)
    for axis in range(3):
        text += "*STEP\n*STATIC, SOLVER=SPOOLES\n*BOUNDARY, OP=MOD\n"
        text += "".join("PATCH, %d, %d, %g\n" % (k + 1, k + 1, float(k == axis)) for k in range(3))
        text += "*NODE PRINT, NSET=SEEN\nU\n*END STEP\n"
    (folder / "job.inp").write_text(text)
    subprocess.run(["ccx", "-i", "job"], cwd=folder, check=True, capture_output=True)
    rows = [line.split() for line in (folder / "job.dat").read_text().split("\n")]
    rows = [row for row in rows if len(row) == 4 and row[0].isdigit()]
    assert [int(row[0]) - 1 for row in rows[: len(seen)]] == list(seen)
    u = np.array([[float(v) for v in row[1:]] for row in rows]).reshape(3, len(seen), 3)
    return np.moveaxis(u, 0, 2)


def by_hapsim(folder, bin, body_file, point, radius, nu, points):
    with open(folder / "motion.csv", "w") as out:
        out.write("# tool_radius: %g\npress,t,x,y,z,ux,uy,uz\n" % (1e-3 * radius))
        for axis in range(3):
            u = [1e-5 * float(axis == k) for k in range(3)]
            out.write("%d,%d,%.9g,%.9g,%.9g,%g,%g,%g\n" % (axis + 1, axis, *(1e-3 * point), *u))
    with open(folder / "model.csv", "w") as out:
        out.write("effect,region,parameter,value,unit,std_error,lower,upper,state\n"
                  "elastic,0,E,%g,Pa,,,,fixed\nelastic,0,nu,%g,1,,,,fixed\n" % (MODULUS, nu))
    with open(folder / "points.csv", "w") as out:
        out.write("point,x_mm,y_mm,z_mm\n")
        out.write("".join("%d,%.9g,%.9g,%.9g\n" % (k, *p) for k, p in enumerate(points)))
    subprocess.run([bin / "hs-simulate", "-q", folder / "motion.csv", "--body", body_file, "--model",
                    folder / "model.csv", "--markers", folder / "points.csv", "--markers-out", folder / "moved.csv",
                    "-o", folder / "forces.csv"], check=True)
    with open(folder / "moved.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    gains = np.full((len(points), 3, 3), np.nan)
    for row in rows:
        gains[int(row["point"]), :, int(row["press"]) - 1] = [float(row[c]) / 1e-5 for c in ("ux", "uy", "uz")]
    return gains


def show(what, nu, exact, own, far):
    off = np.abs(own - exact).reshape(len(exact), -1).max(axis=1)
    near = far < 2
    print("%-44s nu %.2f: %2d points, off by at most %.2f %% of the tool's displacement (rms %.2f; beyond two radii "
          "at most %.2f)" % (what, nu, len(exact), 100 * off.max(), 100 * np.sqrt(np.mean((own - exact) ** 2)),
                             100 * off[~near].max()), flush=True)
    return off.max()


def main():
    bin = pathlib.Path(sys.argv[1]).resolve()
    radius = float(sys.argv[2]) if len(sys.argv) > 2 else 4.0
    worst = 0.0
    with tempfile.TemporaryDirectory(prefix="hapsim-markers-") as name:
        folder = pathlib.Path(name)
        files = {}
        for body, point, what in CASES:
            if body not in files:
                files[body] = body_of(folder, bin, body)
            p, n = place_of(body, point)
            mesh = meshes.Mesh(body, (p, n), radius, folder, (p, 1.0, 14.0), rim=0.3, growth=0.4)
            seen = seen_nodes(mesh, p, radius)
            points = mesh.nodes[seen]
            far = np.linalg.norm(points - p, axis=1) / radius
            every = np.arange(len(mesh.tets))
            for nu in (0.3, 0.45):
                exact = by_calculix(folder, mesh, [(calculix.isotropic("A", MODULUS, nu), every)], seen)
                worst = max(worst, show(body + ", " + what, nu, exact,
                                        by_hapsim(folder, bin, files[body], p, radius, nu, points), far))
    print("largest difference: %.2f %% of the tool's displacement" % (100 * worst))
    return 0


if __name__ == "__main__":
    sys.exit(main())
