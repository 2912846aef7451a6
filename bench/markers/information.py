"""information.py BIN: which parameters gain by marked points: standard errors from the Fisher information.

A block of 60 x 50 x 40 mm pressed by a tool of 3 mm to 1.5 mm; forces of 4 mN noise and a stiffness that errs by 1 %
at each place, as hs-identify weighs them; twelve points of 20 um noise with an error of 1 % of each gain. Derivatives of
forces and displacements are differences of hs-simulate, and all parameters of a row are free at once. Minutes."""
import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

FORCE_NOISE, MARKER_NOISE, DOUBT = 4e-3, 2e-5, 0.01
PLACES = {"middle": [(30, 25), (35, 20), (24, 30)], "near edges": [(55, 20), (30, 6), (6, 43), (47, 5.5)],
          "beside the border": [(34, 25), (37, 20), (43, 30), (47, 25)]}
SEEN = [(18 + 9 * i, 15 + 10 * j) for i in range(4) for j in range(3)]
HEAD = "effect,region,parameter,value,unit,std_error,lower,upper,state\n"


def block(size=(0.06, 0.05, 0.04)):
    lines = ["OFF", "8 12 0"]
    lines += ["%g %g %g" % ((i % 2) * size[0], (i // 2 % 2) * size[1], (i // 4) * size[2]) for i in range(8)]
    faces = "0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5"
    return "\n".join(lines + ["3 " + f for f in faces.split(",")]) + "\n"


class Bench:
    def __init__(self, bin, folder):
        self.bin, self.folder = bin, folder
        self.bodies = {}

    def body(self, height):
        if height not in self.bodies:
            path = self.folder / ("block-%.6f.ply" % height)
            (self.folder / "box.off").write_text(block((0.06, 0.05, height)))
            subprocess.run([self.bin / "hs-tetmesh", "-q", self.folder / "box.off", "-o", path], check=True)
            self.bodies[height] = path
        return self.bodies[height]

    def motion(self, places, slant, height):
        rows, number = [], 0
        for x, y in places:
            for s in (-1, 0, 1):
                number += 1
                for i in range(11):
                    d = 1.5e-3 * i / 10
                    rows.append((number, 2 * number + 0.1 * i, 1e-3 * x, 1e-3 * y, height,
                                 slant * 0.6 * s * d, slant * (0.5 if s == 0 else 0) * d, -d))
        return "# tool_radius: 0.003\npress,t,x,y,z,ux,uy,uz\n" + "".join(
            "%d,%.6g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n" % row for row in rows)

    def displacements(self, places, slant, p):
        rows = self.motion(places, slant, p.get("height", 0.04)).split("\n")[2:-1]
        return np.array([[float(v) for v in row.split(",")[5:]] for row in rows])

    def measure(self, places, slant, p):
        """Forces (rows, 3) and displacements (rows, points, 3) of the model with these parameters."""
        height, f = p.get("height", 0.04), self.folder
        (f / "motion.csv").write_text(self.motion(places, slant, height))
        (f / "points.csv").write_text("point,x_mm,y_mm,z\n" + "".join(
            "%d,%.9g,%.9g,%.9g\n" % (k, x, y, height) for k, (x, y) in enumerate(SEEN)))
        text = HEAD + "elastic,0,E,%.12g,Pa,,,,fixed\n" % p["E"]
        if "ratio" in p:
            text += "elastic,1,E,%.12g,Pa,,,,fixed\n" % (p["E"] * p["ratio"])
        text += "elastic,0,nu,%.12g,1,,,,fixed\n" % p["nu"]
        if "ratio" in p:
            for region, x in ((0, p["border"] - 0.012), (1, p["border"] + 0.012)):
                text += "regions,%d,x%d,%.12g,m,,,,fixed\nregions,%d,y%d,0.025,m,,,,fixed\n" % (
                    region, region + 1, x, region, region + 1)
        (f / "model.csv").write_text(text)
        subprocess.run([self.bin / "hs-simulate", "-q", f / "motion.csv", "--body", self.body(height), "--model",
                        f / "model.csv", "--markers", f / "points.csv", "--markers-out", f / "moved.csv", "-o",
                        f / "forces.csv"], check=True)
        table = lambda name: list(csv.DictReader(l for l in open(f / name) if not l.startswith("#")))
        force = np.array([[float(r[c]) for c in ("fx", "fy", "fz")] for r in table("forces.csv")])
        moved = np.array([[float(r[c]) for c in ("ux", "uy", "uz")] for r in table("moved.csv")])
        return force, moved.reshape(len(force), len(SEEN), 3)


def whitened(slopes, deviations, groups, noise):
    """Slopes (n, parameters) over the root of noise^2 I + Z Z', Z (n, k) by group."""
    out = slopes / noise
    for g in np.unique(groups):
        rows = groups == g
        Q, s, _ = np.linalg.svd(deviations[rows] / noise, full_matrices=False)
        out[rows] -= Q @ ((1 - 1 / np.hypot(1, s))[:, None] * (Q.T @ out[rows]))
    return out


def of_forces(f):
    """The six symmetric relative changes of a place's stiffness as they act on its forces (rows, 3)."""
    pairs = [(2, 2), (0, 0), (1, 1), (0, 1), (0, 2), (1, 2)]
    Z = np.zeros((len(f), 3, 6))
    for k, (i, j) in enumerate(pairs):
        Z[:, i, k] += f[:, j]
        if i != j:
            Z[:, j, k] += f[:, i]
    return DOUBT * Z.reshape(-1, 6)


def of_points(u, y):
    """The entries of a point's gain, each by its column's size, as they act on its displacements."""
    G = np.linalg.lstsq(u, y, rcond=1e-9)[0].T
    Z = np.zeros((len(u), 3, 9))
    for i in range(3):
        for j in range(3):
            Z[:, i, 3 * i + j] = DOUBT * np.linalg.norm(G[:, j]) * u[:, j]
    return Z.reshape(-1, 9)


def tell(bench, name, places, slant, p, steps):
    measure = lambda q: bench.measure(places, slant, q)
    force, moved = measure(p)
    by_force, by_moved = [], []
    for key, step in steps.items():
        up, down = measure({**p, key: p[key] + step}), measure({**p, key: p[key] - step})
        by_force.append((up[0] - down[0]).ravel() / (2 * step))
        by_moved.append((up[1] - down[1]) / (2 * step))
    place = np.repeat(np.arange(len(places)), 33)
    J_force = whitened(np.array(by_force).T, np.concatenate([of_forces(force[place == k]) for k in range(len(places))]),
                       np.repeat(place, 3), FORCE_NOISE)
    u = bench.displacements(places, slant, p)
    J_moved = []
    for k, (a, b) in enumerate(places):
        for m, (x, y) in enumerate(SEEN):
            if np.hypot(x - a, y - b) < 3:
                continue  # under the tool
            rows = place == k
            slopes = np.array([d[rows, m].ravel() for d in by_moved]).T
            J_moved.append(whitened(slopes, of_points(u[rows], moved[rows, m]), np.zeros(len(slopes)), MARKER_NOISE))
    J_moved = np.concatenate(J_moved)
    alone = J_force.T @ J_force
    both = alone + J_moved.T @ J_moved
    def error(m):
        scale = 1 / np.sqrt(np.diag(m))  # of parameters of all units
        return scale * np.sqrt(np.diag(np.linalg.inv(m * np.outer(scale, scale))))
    for k, key in enumerate(steps):
        unit, scale = {"E": ("%", 100 / p["E"]), "ratio": ("%", 100 / p.get("ratio", 1)), "nu": ("", 1)}.get(key, ("mm", 1e3))
        a, b = scale * error(alone)[k], scale * error(both)[k]
        print("%-46s %-7s +- %9.4g %-2s by forces, %9.4g with points, %6.2f times less" % (name, key, a, unit, b, a / b),
              flush=True)


def main():
    with tempfile.TemporaryDirectory(prefix="hapsim-information-") as name:
        bench = Bench(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(name))
        one, two = {"E": 2e5, "nu": 0.42}, {"E": 2e5, "nu": 0.42, "ratio": 3.0, "border": 0.040}
        steps = {"E": 200, "nu": 1e-3}
        for where in ("middle", "near edges"):
            for slant, how in ((0, "straight down"), (1, "slanted")):
                tell(bench, "%s, %s" % (where, how), PLACES[where], slant, one, steps)
        for slant, how in ((0, "straight down"), (1, "slanted")):
            tell(bench, "border between two regions, %s" % how, PLACES["beside the border"], slant, two,
                 {**steps, "ratio": 0.01, "border": 1e-3})
        thin = {**one, "height": 0.012}
        for slant, how in ((0, "straight down"), (1, "slanted")):
            tell(bench, "a layer of 12 mm on its support, %s" % how, PLACES["middle"], slant, thin,
                 {**steps, "height": 1e-4})


if __name__ == "__main__":
    main()
