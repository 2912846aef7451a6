"""paths.py OUT BODY: forces along presses of a stiffening body at finite strain, by CalculiX.

W = mu/(2b) (exp(b (I1 - 3)) - 1) + kappa/2 (J - 1)^2, to third order in I1 - 3 (Yeoh); I1 of the
isochoric part. Kept in OUT/paths/BODY/PLACE-WAY.txt: rows of share of the way, fx, fy, fz."""
import concurrent.futures
import pathlib
import sys
import tempfile

import numpy as np

import bodies
import calculix
import meshes
import motion
import variants

STIFFENING = {"cuboid": 2.0, "ball": 2.5, "organ": 3.0}
RADIUS = 4.0
SEED = 77  # of the session, which says how each place is pressed aslant


def material(body):
    mu = variants.MODULUS / (2 * (1 + variants.POISSON[body]))
    kappa = variants.MODULUS / (3 * (1 - 2 * variants.POISSON[body]))
    b = STIFFENING[body]
    values = (mu / 2, mu * b / 4, mu * b * b / 12, 2 / kappa, 0, 0)
    return "*MATERIAL, NAME=A\n*HYPERELASTIC, YEOH\n" + ", ".join("%.8g" % v for v in values) + "\n"


def session(body):
    return motion.session(bodies.places(body), SEED)


def ways(body):
    """{(place, aslant): displacement at the end [mm]}: the deepest press of each kind."""
    deepest = {}
    for p in session(body):
        target = 1e3 * p.u[-1]
        aslant = bool(np.linalg.norm(np.cross(target, p.n)) > 1e-3)
        if np.linalg.norm(target) > np.linalg.norm(deepest.get((p.place, aslant), np.zeros(3))):
            deepest[(p.place, aslant)] = target
    return deepest


def file_of(out, body, place, aslant):
    return pathlib.Path(out) / "paths" / body / ("%02d-%s.txt" % (place, "aslant" if aslant else "straight"))


def solve(out, body, place, aslant, target):
    name = file_of(out, body, place, aslant)
    if name.exists():
        return
    middle, ball, _ = variants.INCLUSION[body]
    with tempfile.TemporaryDirectory(prefix="hapsim-bench-") as folder:
        folder = pathlib.Path(folder)
        mesh = meshes.Mesh(body, bodies.places(body)[place], RADIUS, folder, (middle, ball, ball), 0.5, 0.5)
        text = calculix.deck(mesh, [(material(body), np.arange(len(mesh.tets)))], mesh.bottom)
        text += "*STEP, NLGEOM, INC=200\n*STATIC, SOLVER=ITERATIVE CHOLESKY\n0.1, 1, 1e-3, 0.125\n*BOUNDARY\n"
        text += "".join("PATCH, %d, %d, %.8g\n" % (k + 1, k + 1, target[k]) for k in range(3))
        text += "*NODE PRINT, NSET=PATCH, TOTALS=ONLY\nRF\n*END STEP\n"
        rows = calculix.run(folder, text)
    rows[:, 1:] *= -1e-6  # moduli in Pa with lengths in mm; the force on the tool
    name.parent.mkdir(parents=True, exist_ok=True)
    np.savetxt(name.with_suffix(".part"), np.vstack([np.zeros(4), rows]))
    name.with_suffix(".part").rename(name)
    print(body, place, "aslant" if aslant else "straight", flush=True)


def forces(out, body, press, target):
    """(n, 3) [N] of a press; `target`: where its way's table ends [mm]."""
    aslant = bool(np.linalg.norm(np.cross(target, press.n)) > 1e-3)
    table = np.loadtxt(file_of(out, body, press.place, aslant))
    share = 1e3 * np.linalg.norm(press.u, axis=1) / np.linalg.norm(target)
    # The secant stiffness is smooth in the way.
    x = table[1:, 0]
    fit = [np.polynomial.Polynomial.fit(x, f / x, 4) for f in table[1:, 1:].T]
    return np.array([share * q(share) for q in fit]).T


if __name__ == "__main__":
    out, body = sys.argv[1:3]
    jobs = [(out, body, *way, target) for way, target in sorted(ways(body).items())]
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        list(pool.map(solve, *zip(*jobs)))
