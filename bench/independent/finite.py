"""finite.py OUT NAME...: forces of bodies that stiffen at finite strain, by CalculiX, for cases with `stiffens`.

Kept in OUT/curves/NAME/PLACE-DIRECTION.txt, one row an increment: way of the tool [m], force on it [N]. A
direction is pressed once, to the largest depth that the recording needs; the body forgets nothing."""
import pathlib
import sys
import tempfile

import numpy as np

import bodies
import calculix
import cases
import meshes
import motion
import variants

# Edge length at the tool's rim [mm] and its growth: the strain there is singular, and elements much
# smaller than the way of the tool turn inside out.
RIM, GROWTH = 1.2, 0.9


def stiffening(name, modulus, poisson, b):
    """W = mu/(2 b) (exp(b (I1 - 3)) - 1) + kappa/2 (J - 1)^2 to its third order (Yeoh's law)."""
    mu, kappa = modulus / (2 * (1 + poisson)), modulus / (3 * (1 - 2 * poisson))
    return "*MATERIAL, NAME=%s\n*HYPERELASTIC, YEOH\n%.8g, %.8g, %.8g, %.8g, 0, 0\n" % (
        name, mu / 2, mu * b / 4, mu * b**2 / 12, 2 / kappa)


def presses(case):
    return motion.session(cases.places(case), cases.seed(case), case.get("holds", (2.0, 3.0)),
                          aslant=case.get("aslant", 12))


def directions(case):
    """By (place, direction): unit vector and the longest way along it [m]."""
    found, numbers = {}, {}
    for p in presses(case):
        way = np.linalg.norm(p.u[-1])
        known = numbers.setdefault(p.place, [])
        unit = p.u[-1] / way
        k = next((k for k, other in enumerate(known) if other @ unit > 1 - 1e-9), len(known))
        if k == len(known):
            known.append(unit)
        found[p.place, k] = (unit, max(way, found.get((p.place, k), (unit, 0))[1]))
    return found


def file_of(out, case, key):
    return pathlib.Path(out) / "curves" / case["name"] / ("%02d-%d.txt" % key)


def curve(folder, mesh, b, nu, unit, way):
    """Rows of way [m] and force on the tool [N]."""
    every = np.arange(len(mesh.tets))
    text = calculix.deck(mesh, [(stiffening("A", variants.MODULUS, nu, b), every)], mesh.bottom)
    step = 1e-4 / way  # a tenth of a millimetre: more makes the first guess of an increment too wild
    text += "*STEP, NLGEOM, INC=1000\n*STATIC, SOLVER=SPOOLES\n%.6g, 1, 1e-5, %.6g\n*BOUNDARY\n" % (step, 1.5 * step)
    text += "".join("PATCH, %d, %d, %.9g\n" % (k + 1, k + 1, 1e3 * way * unit[k]) for k in range(3))
    text += "*NODE PRINT, NSET=PATCH, TOTALS=ONLY\nRF\n*END STEP\n"
    rows = calculix.run(folder, text)
    # A force unit is 1e-6 N (calculix.stiffness); what holds the patch is what it does to the body.
    return np.column_stack([way * rows[:, 0], -1e-6 * rows[:, 1:]])


def solve(out, case):
    body = case["body"]
    for key, (unit, way) in sorted(directions(case).items(), key=lambda item: item[0][::-1]):
        target = file_of(out, case, key)
        if target.exists():
            continue
        with tempfile.TemporaryDirectory(prefix="hapsim-bench-") as folder:
            folder = pathlib.Path(folder)
            place = bodies.places(body)[key[0]]
            mesh = meshes.Mesh(body, place, case["radius"], folder, (place[0], 1, 14), RIM, GROWTH)
            rows = curve(folder, mesh, case["stiffens"], variants.POISSON[body], unit, way)
        if abs(rows[-1, 0] - way) > 1e-9:
            raise RuntimeError("%s %s: CalculiX stopped at %g m of %g m" % (case["name"], key, rows[-1, 0], way))
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_suffix(".part")
        np.savetxt(part, np.vstack([np.zeros(4), rows]))
        part.rename(target)
        print(case["name"], *key, len(rows), flush=True)


def forces(case, every_press, out):
    """As make.forces: straight between the increments."""
    found = directions(case)
    result = []
    for p in every_press:
        way = np.linalg.norm(p.u, axis=1)
        key = next(k for k, (unit, _) in found.items() if k[0] == p.place and unit @ p.u[-1] > (1 - 1e-9) * way[-1])
        rows = np.loadtxt(file_of(out, case, key))
        result.append(np.array([np.interp(way, rows[:, 0], f) for f in rows[:, 1:].T]).T)
    return result


if __name__ == "__main__":
    out, wanted = sys.argv[1], sys.argv[2:]
    for case in cases.every_case():
        if "stiffens" in case and (not wanted or case["name"] in wanted):
            solve(out, case)
