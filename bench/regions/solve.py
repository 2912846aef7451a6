"""solve.py OUT NAME...: the contact stiffness of every place of the blocks with two regions, by CalculiX.

Kept in OUT/stiffness/NAME/PLACE.txt (3 x 3 [N/m]) and not computed again. Gmsh's mesh of a place is graded to the tool's
rim and to the boundary near it, which elements follow by their centroids."""
import pathlib
import sys
import tempfile
import time

import numpy as np

import calculix
import meshes
import plates
import variants


def file_of(out, name, k):
    return pathlib.Path(out) / "stiffness" / name / ("%02d.txt" % k)


def solve(out, name):
    formula = variants.TWO_PARTS[name][3]
    for k, place in enumerate(plates.places(name)):
        target = file_of(out, name, k)
        if target.exists():
            continue
        began = time.time()
        with tempfile.TemporaryDirectory(prefix="hapsim-regions-") as folder:
            folder = pathlib.Path(folder)
            mesh = meshes.Mesh("cuboid", place, plates.TOOL, folder, (place[0], 1, 14), more="1.5+0.3*abs%s" % formula)
            K = calculix.stiffness(folder, mesh, *variants.build(name, "cuboid", mesh))
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_suffix(".part")
        np.savetxt(part, K)
        part.rename(target)
        print("%s %d: %d elements, %.0f s" % (name, k, len(mesh.tets), time.time() - began), flush=True)


if __name__ == "__main__":
    for name in sys.argv[2:]:
        solve(sys.argv[1], name)
