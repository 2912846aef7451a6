"""Regions that are thin or small beside the elements of a contact mesh: a block with one, by CalculiX on meshes of
Gmsh's that follow it.

small.py OUT [SHAPE...] computes the contact stiffness above every shape at every ratio of moduli and at equal
moduli, all on one mesh, OUT/small/SHAPE/PLACE-RATIO.txt (3 x 3 [N/m]), and writes OUT/small/SHAPE.stl [m]. Nothing that is there is
solved again."""
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

import bodies
import calculix
import closed
import meshes
from closed import Ball, Box

# name: shape, edge length of the mesh in it [mm], ratios; the block's top is at 60 mm
SHAPES = {
    "sheet-0.8": (Box((48, 95, 50.2), (72, 115, 51)), 1.4, (0.01, 100, 0.3, 5)),
    "sphere-2.5": (Ball(60, 105, 54, 2.5), 0.9, (0.01, 100, 0.3, 5)),
    "sphere-9": (Ball(60, 105, 47, 9), 3.0, (0.02, 0.3, 50, 0.01, 100)),
    "sheet-2": (Box((48, 95, 49), (72, 115, 51)), 1.8, (0.01, 100, 0.3, 5)),
    "sheet-4": (Box((48, 95, 47), (72, 115, 51)), 2.2, (0.01, 100)),
}
SKINS = {"skin-2.5": (2.5, (5, 0.3, 50)), "skin-0.6": (0.6, (5, 0.3, 50))}  # thickness [mm], ratios
PLACES = closed.PLAN[:1]  # above its middle
# Coarser at the rim than closed.py: what the region changes of the stiffness of the same mesh is compared.
closed.RIM, closed.GROWTH = 0.7, 0.4

for shape, (solid, edge, _) in SHAPES.items():
    closed.CASES[shape] = ("cuboid", [(solid, 1.0, edge)])


def file_of(out, shape, place, ratio):
    return pathlib.Path(out) / "small" / shape / ("%d-%g.txt" % (place, ratio))


class SkinMesh(meshes.Mesh):
    """Of the block, with the inner face of a skin under all that is not bonded: region 1."""

    def __init__(self, shape, place, folder):
        thickness = SKINS[shape][0]
        super().__init__("cuboid", place, closed.TOOL, folder, (place[0], 1, 14), closed.RIM, closed.GROWTH, thickness, "", True)
        shallow = bodies.depth_below("cuboid", self.centroids) < thickness
        skin = [v for v in np.unique(self.volumes) if np.mean(shallow[self.volumes == v]) > 0.5]
        self.region = np.isin(self.volumes, skin).astype(int)


def solve(out, shape, k):
    place = (np.array([*PLACES[k], 60.0]), np.array([0.0, 0.0, 1.0]))
    wanted = [ratio for ratio in (1, *(SKINS.get(shape) or SHAPES[shape])[-1]) if not file_of(out, shape, k, ratio).exists()]
    if not wanted:
        return
    with tempfile.TemporaryDirectory(prefix="hapsim-small-") as folder:
        folder = pathlib.Path(folder)
        mesh = (SkinMesh if shape in SKINS else closed.PlaceMesh)(shape, place, folder)
        for ratio in wanted:
            began = time.time()
            parts = [(calculix.isotropic("M%d" % r, (1, ratio)[r] * closed.MODULUS, closed.POISSON), np.flatnonzero(mesh.region == r))
                     for r in (0, 1)]
            K = calculix.patch_stiffness(folder, mesh, parts, mesh.bottom)
            target = file_of(out, shape, k, ratio)
            target.parent.mkdir(parents=True, exist_ok=True)
            np.savetxt(target.with_suffix(".part"), K)
            target.with_suffix(".part").rename(target)
            print("%s %d %g: %d elements, %.0f s" % (shape, k, ratio, len(mesh.tets), time.time() - began), flush=True)


def write_surface(out, shape):
    target = pathlib.Path(out) / "small" / (shape + ".stl")
    target.parent.mkdir(parents=True, exist_ok=True)
    if target.exists():
        return
    solid, edge, _ = SHAPES[shape]
    script = target.with_suffix(".geo")
    script.write_text('SetFactory("OpenCASCADE");\n%sMesh.CharacteristicLengthMax = %g;\nMesh.ScalingFactor = 0.001;\n'
                      % (solid.shape(1), edge / 2 if isinstance(solid, Ball) else 2))
    subprocess.run(["gmsh", script, "-2", "-format", "stl", "-o", target, "-v", "2"], check=True)
    script.unlink()


if __name__ == "__main__":
    out = sys.argv[1]
    names = sys.argv[2:] or [*SHAPES, *SKINS]
    for shape in names:
        if shape not in SKINS:
            write_surface(out, shape)
    for k in range(len(PLACES)):
        for shape in names:
            solve(out, shape, k)
