"""torques.py BIN [RADIUS]: the tool's lever, torque over force, by CalculiX and by hs-simulate --torques.

CalculiX: second-order tetrahedra of Gmsh's, moments of the patch's nodal reactions about the contact; on a
cuboid in the middle, near an edge and in a corner, on a ball and on an organ, for two Poisson's ratios, and near
an edge with a region of another stiffness beside the tool. Minutes."""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import bodies
import calculix
import meshes

MODULUS = 2.0e4  # [Pa]
CASES = [("cuboid", (60, 105, 60), "the middle"), ("cuboid", (114, 105, 60), "6 mm from an edge"),
         ("cuboid", (113, 203, 60), "7 mm from two"), ("ball", None, "30 degrees off the top"),
         ("organ", None, "off its top")]


def place_of(body, point):
    if point is not None:
        return np.array(point, dtype=float), np.array([0.0, 0.0, 1.0])
    return (bodies.on_ball if body == "ball" else bodies.on_organ)((0.5, 0.0, 0.87))


def reactions(folder, text, nodes):
    """Of each step (k, n, 3) [1e-6 N for moduli in Pa and lengths in mm]."""
    (folder / "job.inp").write_text(text)
    subprocess.run(["ccx", "-i", "job"], cwd=folder, check=True, capture_output=True)
    rows = [line.split() for line in (folder / "job.dat").read_text().split("\n")]
    forces = np.array([[float(v) for v in row[1:]] for row in rows if len(row) == 4 and row[0].isdigit()])
    return forces.reshape(-1, nodes, 3)


def by_calculix(folder, mesh, materials, point):
    """Lever (3, 3) [mm] by the tractions that move the patch along each axis."""
    text = calculix.deck(mesh, materials, mesh.bottom)
    for axis in range(3):
        text += "*STEP\n*STATIC, SOLVER=SPOOLES\n*BOUNDARY, OP=MOD\n"
        text += "".join("PATCH, %d, %d, %g\n" % (k + 1, k + 1, float(k == axis)) for k in range(3))
        text += "*NODE PRINT, NSET=PATCH\nRF\n*END STEP\n"
    # CalculiX prints the nodes of a set in ascending order.
    force = reactions(folder, text, len(mesh.patch))
    arms = mesh.nodes[np.sort(mesh.patch)] - point
    K = force.sum(axis=1).T
    T = np.cross(arms[None], force).sum(axis=1).T
    return T @ np.linalg.inv(K)


def by_hapsim(folder, bin, body_file, point, radius, nu, regions="", more=()):
    """Lever (3, 3) [mm] from presses along each axis."""
    with open(folder / "motion.csv", "w") as out:
        out.write("# tool_radius: %g\npress,x,y,z,ux,uy,uz\n" % (1e-3 * radius))
        for axis in range(3):
            u = [1e-5 * float(axis == k) for k in range(3)]
            out.write("%d,%.9g,%.9g,%.9g,%g,%g,%g\n" % (axis + 1, *(1e-3 * point), *u))
    with open(folder / "model.csv", "w") as out:
        out.write("effect,region,parameter,value,unit,std_error,lower,upper,state\n"
                  "elastic,0,E,%g,Pa,,,,fixed\nelastic,0,nu,%g,1,,,,fixed\n%s" % (MODULUS, nu, regions))
    out = folder / "forces.csv"
    subprocess.run([bin / "hs-simulate", "-q", folder / "motion.csv", "--body", body_file, "--model",
                    folder / "model.csv", "--torques", *more, "-o", out], check=True)
    lines = [line for line in out.read_text().split("\n") if line and not line.startswith("#")]
    names = lines[0].split(",")
    rows = np.array([[float(v) for v in line.split(",")] for line in lines[1:]])
    columns = lambda words: rows[:, [names.index(w) for w in words]].T
    return 1e3 * columns(["tqx", "tqy", "tqz"]) @ np.linalg.inv(columns(["fx", "fy", "fz"]))


def body_of(folder, bin, body):
    """As a user meshes its surface: the exact shape, triangulated by Gmsh."""
    script = folder / (body + ".geo")
    script.write_text('SetFactory("OpenCASCADE");\n%s\nMesh.CharacteristicLengthMax = 4;\n' % bodies.shape(body))
    subprocess.run(["gmsh", script, "-2", "-o", folder / (body + ".stl"), "-v", "2"], check=True, capture_output=True)
    subprocess.run([bin / "hs-tetmesh", "-q", folder / (body + ".stl"), "--unit", "mm", "-o", folder / (body + ".ply")],
                   check=True)
    return folder / (body + ".ply")


def show(what, nu, exact, own, radius):
    off = np.abs(own - exact).max()
    big = np.unravel_index(np.argmax(np.abs(exact)), (3, 3))
    print("%-44s nu %.2f: largest entry %+.4f mm by CalculiX, %+.4f by hapsim (%+.2f %%); off by at most %.4f mm = "
          "%.2f %% of the radius" % (what, nu, exact[big], own[big], 100 * (own[big] / exact[big] - 1), off,
                                     100 * off / radius), flush=True)
    return off / radius


def main():
    bin = pathlib.Path(sys.argv[1]).resolve()
    radius = float(sys.argv[2]) if len(sys.argv) > 2 else 4.0
    worst = 0.0
    with tempfile.TemporaryDirectory(prefix="hapsim-torques-") as name:
        folder = pathlib.Path(name)
        files = {}
        for body, point, what in CASES:
            if body not in files:
                files[body] = body_of(folder, bin, body)
            p, n = place_of(body, point)
            mesh = meshes.Mesh(body, (p, n), radius, folder, (p, 1.0, 14.0), rim=0.3, growth=0.5)
            every = np.arange(len(mesh.tets))
            for nu in (0.3, 0.45):
                exact = by_calculix(folder, mesh, [(calculix.isotropic("A", MODULUS, nu), every)], p)
                worst = max(worst, show(body + ", " + what, nu, exact,
                                        by_hapsim(folder, bin, files[body], p, radius, nu), radius))
    print("largest difference: %.2f %% of the tool's radius" % (100 * worst))
    return 0 if worst < 0.02 else 1


if __name__ == "__main__":
    sys.exit(main())
