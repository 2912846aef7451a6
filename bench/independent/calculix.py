"""Contact stiffness of a flat bonded tool by CalculiX: every node of the patch moves alike."""
import os
import subprocess

import numpy as np


def number_list(values, per_line=12):
    values = [str(v) for v in values]
    return "\n".join(",".join(values[i : i + per_line]) for i in range(0, len(values), per_line))


def isotropic(name, modulus, poisson):
    return "*MATERIAL, NAME=%s\n*ELASTIC\n%.10g, %.10g\n" % (name, modulus, poisson)


def transverse(name, modulus, ratio, poisson):
    """Stiffer along the third local axis: `modulus` across it, `ratio` times that along it; strain
    across by tension along it is `poisson` sqrt(ratio) times that along (positive for every ratio)."""
    across = modulus / (2 * (1 + poisson))
    # CalculiX: E1, E2, E3, nu12, nu13, nu23, G12, G13, / G23; nu13 for tension along 1.
    values = (modulus, modulus, modulus * ratio, poisson, poisson / np.sqrt(ratio), poisson / np.sqrt(ratio),
              across, across * np.sqrt(ratio), across * np.sqrt(ratio))
    return ("*MATERIAL, NAME=%s\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n" % name
            + ", ".join("%.8g" % v for v in values[:8]) + "\n%.8g\n" % values[8])


def deck(mesh, materials, fixed, orientation=""):
    """The model's part of an input file. `materials`: list of (definition, indices of elements)."""
    lines = ["*NODE, NSET=ALL"]
    lines += ["%d, %.9g, %.9g, %.9g" % (i + 1, *x) for i, x in enumerate(mesh.nodes)]
    lines += ["*ELEMENT, TYPE=C3D10, ELSET=BODY"]
    lines += ["%d, %s" % (i + 1, ", ".join(str(k + 1) for k in t)) for i, t in enumerate(mesh.tets)]
    lines += ["*NSET, NSET=PATCH", number_list(mesh.patch + 1), "*NSET, NSET=FIXED", number_list(fixed + 1)]
    if orientation:
        lines += ["*ORIENTATION, NAME=AXES", orientation]
    for k, (definition, elements) in enumerate(materials):
        if len(elements) == 0:
            continue
        lines += ["*ELSET, ELSET=PART%d" % k, number_list(elements + 1), definition.rstrip()]
        name = definition.split("NAME=")[1].split("\n")[0]
        axes = ", ORIENTATION=AXES" if orientation else ""
        lines += ["*SOLID SECTION, ELSET=PART%d, MATERIAL=%s%s" % (k, name, axes)]
    return "\n".join(lines + ["*BOUNDARY", "FIXED, 1, 3", ""])


def run(folder, text):
    """The patch's total force at every printed increment (k, 4): time, fx, fy, fz."""
    (folder / "job.inp").write_text(text)
    done = subprocess.run(["ccx", "-i", "job"], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    rows, time = [], 0.0
    for line in (folder / "job.dat").read_text().split("\n") if (folder / "job.dat").exists() else []:
        if "total force" in line:
            time = float(line.split()[-1])
        elif len(line.split()) == 3:
            rows.append([time] + [float(v) for v in line.split()])
    for path in folder.glob("job.*"):
        if path.suffix != ".inp":
            path.unlink()
    if done.returncode != 0 or "*ERROR" in done.stdout or not rows:
        raise RuntimeError("ccx failed in %s: %s" % (folder, done.stdout[-600:]))
    return np.array(rows)


def stiffness(folder, mesh, materials, fixed, orientation=""):
    """K (3, 3) [N/m]: force on the tool = -K u. By a direct solver: iterated reactions are asymmetric by 1 to 15 %."""
    text = deck(mesh, materials, fixed, orientation)
    for axis in range(3):
        text += "*STEP\n*STATIC, SOLVER=SPOOLES\n*BOUNDARY, OP=MOD\n"
        text += "".join("PATCH, %d, %d, %g\n" % (k + 1, k + 1, float(k == axis)) for k in range(3))
        text += "*NODE PRINT, NSET=PATCH, TOTALS=ONLY\nRF\n*END STEP\n"
    rows = run(folder, text)
    if rows.shape != (3, 4) or not np.all(np.isfinite(rows)):
        raise RuntimeError("ccx found no stiffness in %s" % folder)
    # Moduli in Pa with lengths in mm: a force unit is 1e-6 N, for 1 mm.
    return rows[:, 1:].T * 1e-6 / 1e-3


def patch_stiffness(folder, mesh, materials, fixed):
    """K (3, 3) [N/m] of a rigid patch: force on the tool = -K u. Its inverse is what unit forces on the patch move it by, three right
    sides of one factorisation. `mesh`: nodes [mm], tets, patch; moduli in Pa."""
    tool = len(mesh.nodes) + 1
    text = deck(mesh, materials, fixed)
    text = text.replace("*ELEMENT,", "%d, 0, 0, 0\n*NSET, NSET=TOOL\n%d\n*ELEMENT," % (tool, tool), 1)
    rigid = "*EQUATION\n" + "".join("2\n%d, %d, 1., %d, %d, -1.\n" % (node + 1, axis, tool, axis)
                                    for node in mesh.patch for axis in (1, 2, 3))
    text = text.replace("*BOUNDARY\n", rigid + "*BOUNDARY\n", 1)
    text += "*STEP\n*GREEN, SOLVER=SPOOLES\n*CLOAD\n" + "".join("%d, %d, 1.\n" % (tool, axis) for axis in (1, 2, 3))
    text += "*NODE PRINT, NSET=TOOL\nU\n*END STEP\n"
    (folder / "job.inp").write_text(text)
    done = subprocess.run(["ccx", "-i", "job"], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    rows = [line.split() for line in (folder / "job.dat").read_text().split("\n")]
    found = np.array([[float(v) for v in row[1:]] for row in rows if len(row) == 4 and row[0] == str(tool)])
    if done.returncode != 0 or found.shape != (3, 3):
        raise RuntimeError("ccx failed in %s: %s" % (folder, done.stdout[-600:]))
    # Moduli in Pa with lengths in mm: a force unit is 1e-6 N, for 1 mm.
    return np.linalg.inv(found) * 1e-6 / 1e-3
