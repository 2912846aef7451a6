"""Bodies with closed regions inside them as exact solids [mm]: what lies where, where it is pressed, by CalculiX.

closed.py OUT [CASE...] computes the contact stiffness of every place, OUT/closed/CASE/PLACE.txt (3 x 3 [N/m]; of some cases PLACE.even.txt
with equal moduli on the same mesh), and writes the surface of each region, OUT/closed/CASE-N.stl [m]. A mesh a place, by
Gmsh: second order, the tool's patch and the regions' boundaries imprinted, quarter points at the rim."""
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

import bodies
import calculix
import meshes

TOOL, RIM, GROWTH = 4.0, 0.42, 0.3
MODULUS, POISSON = 2.0e4, 0.42


class Ball:
    def __init__(self, x, y, z, r, stretch=(1, 1, 1)):
        self.middle, self.radius, self.stretch = np.array([x, y, z], float), r, np.array(stretch, float)

    def inside(self, p):
        return np.linalg.norm((p - self.middle) / self.stretch, axis=1) < self.radius

    def smaller(self, by):
        return Ball(*self.middle, self.radius - by)

    def shape(self, number):
        return ("Sphere(%d) = {0, 0, 0, %g};\nDilate{ {0, 0, 0}, {%g, %g, %g} }{ Volume{%d}; }\n"
                "Translate{ %g, %g, %g }{ Volume{%d}; }\n" % (number, self.radius, *self.stretch, number, *self.middle, number))


class Box:
    def __init__(self, low, high):
        self.low, self.high = np.array(low, float), np.array(high, float)

    def inside(self, p):
        return np.all((p > self.low) & (p < self.high), axis=1)

    def smaller(self, by):
        return Box(self.low + by, self.high - by)

    def shape(self, number):
        return "Box(%d) = {%g, %g, %g, %g, %g, %g};\n" % (number, *self.low, *(self.high - self.low))


class Lump:
    """Balls and ellipsoids grown together."""

    def __init__(self, *parts):
        self.parts = parts

    def inside(self, p):
        return np.any([part.inside(p) for part in self.parts], axis=0)

    def shape(self, number):
        numbers = [10 * number + 500 + k for k in range(len(self.parts))]
        text = "".join(part.shape(n) for part, n in zip(self.parts, numbers))
        return text + "BooleanUnion(%d) = { Volume{%d}; Delete; }{ Volume{%s}; Delete; };\n" % (
            number, numbers[0], ", ".join(map(str, numbers[1:])))



# name: body, regions as (shape, modulus over the body's, edge length [mm]), directions or points in plan view pressed
IRREGULAR = Lump(Ball(56, 100, 46, 7), Ball(64, 105, 44, 6, (1.3, 1, 0.8)), Ball(60, 111, 47, 5))
CASES = {
    "sphere-stiff": ("cuboid", [(Ball(60, 105, 47, 9), 5.0, 3.0)]),
    "sphere-soft": ("cuboid", [(Ball(60, 105, 47, 9), 0.3, 3.0)]),
    "box-soft": ("cuboid", [(Box((48, 95, 40), (72, 115, 54)), 0.3, 3.0)]),
    "lump-stiff": ("cuboid", [(IRREGULAR, 5.0, 2.2)]),
    "open-stiff": ("cuboid", [(Box((60, 90, 48), (90, 120, 60)), 3.0, 3.0)]),
    "two": ("cuboid", [(Ball(46, 105, 49, 8), 4.0, 2.7), (Box((64, 92, 42), (86, 118, 55)), 0.4, 3.0)]),
    "ball-stiff": ("ball", [(Ball(6, 4, 68, 9), 5.0, 3.0)]),
    "ball-lump": ("ball", [(Lump(Ball(-8, 6, 66, 7), Ball(0, 2, 68, 6, (1.3, 1, 0.8)), Ball(4, -6, 66, 6)), 0.3, 2.2)]),
}
EVEN = ("sphere-stiff", "ball-stiff")  # with equal moduli too: what the meshes err by themselves
GRID = [(x, y) for y in (93, 105, 117) for x in (34, 47, 60, 73, 86)]  # of the identification
PLAN = [(60, 105), (68, 112), (60, 82)]
DIRECTIONS = [(0.12, 0.08, 1), (-0.12, 0.1, 1), (0.35, -0.1, 1)]


def places(name):
    if CASES[name][0] == "ball":
        return [bodies.on_ball(np.array(d)) for d in DIRECTIONS]
    return [(np.array([x, y, bodies.CUBOID[2]], float), np.array([0.0, 0.0, 1.0]))
            for x, y in (GRID if name == "two" else PLAN)]


def geometry(name, place):
    body, regions = CASES[name]
    p, n = place
    a, b = p - 2 * TOOL * n, 4 * TOOL * n
    away = "((x-(%.9g))*(%.9g)+(y-(%.9g))*(%.9g)+(z-(%.9g))*(%.9g))" % (p[0], n[0], p[1], n[1], p[2], n[2])
    square = "((x-(%.9g))^2+(y-(%.9g))^2+(z-(%.9g))^2)" % tuple(p)
    aside = "sqrt(abs(%s-%s^2))" % (square, away)
    size = "%g+%g*sqrt((%s-%g)^2+%s^2)" % (RIM, GROWTH, aside, TOOL, away)
    text = 'SetFactory("OpenCASCADE");\n%s\n' % bodies.shape(body)
    text += "Cylinder(2) = {%.9g, %.9g, %.9g, %.9g, %.9g, %.9g, %g};\n" % (*a, *b, TOOL)
    text += "part() = BooleanIntersection{ Volume{1}; }{ Volume{2}; Delete; };\n"
    numbers = ["part()"]
    for k, (shape, _, _) in enumerate(regions):
        text += shape.shape(20 + k)
        numbers.append(str(20 + k))
    text += "BooleanFragments{ Volume{1}; Delete; }{ Volume{%s}; Delete; }\n" % ", ".join(numbers)
    text += 'Field[1] = MathEval;\nField[1].F = "%s";\n' % size
    fields = ["1"]
    for k, (shape, _, edge) in enumerate(regions):
        for part in getattr(shape, "parts", [shape]):
            number = 10 + len(fields)
            low, high = ((part.low, part.high) if isinstance(part, Box) else
                         (part.middle - part.radius * part.stretch, part.middle + part.radius * part.stretch))
            text += "Field[%d] = Box;\n" % number + "".join(
                "Field[%d].%sMin = %g;\nField[%d].%sMax = %g;\n" % (number, c, low[i] - 1, number, c, high[i] + 1)
                for i, c in enumerate("XYZ"))
            text += "Field[%d].VIn = %g;\nField[%d].VOut = 14;\nField[%d].Thickness = 20;\n" % (number, edge, number, number)
            fields.append(str(number))
    text += "Field[3] = Min;\nField[3].FieldsList = {%s};\nBackground Field = 3;\n" % ", ".join(fields)
    return text + meshes.SETTINGS


class PlaceMesh(meshes.Mesh):
    def __init__(self, name, place, folder):
        script, result = folder / "mesh.geo", folder / "mesh.msh"
        script.write_text(geometry(name, place))
        done = subprocess.run(["gmsh", script, "-3", "-o", result, "-v", "2", "-nt", "1"], capture_output=True, text=True)
        if done.returncode != 0 or not result.exists():
            raise RuntimeError("gmsh failed on %s: %s" % (script, done.stdout + done.stderr))
        self.nodes, self.tets, self.volumes = meshes.read_msh(result)
        result.unlink()
        p, n = place
        faces = meshes.boundary_faces(self.tets)
        corners = self.nodes[faces[:, :3]] - p
        away = corners @ n
        aside = np.linalg.norm(corners - away[..., None] * n, axis=2)
        inside = np.all((aside < TOOL + 1e-3) & (np.abs(away) < TOOL / 2), axis=1)
        self.patch = np.unique(faces[inside])
        edges = self.nodes[faces[inside]]
        area = 0.5 * np.linalg.norm(np.cross(edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0]), axis=1).sum()
        if not 0.97 < area / (np.pi * TOOL**2) < 1.1:
            raise RuntimeError("%s: the patch has %.3g mm2" % (script, area))
        self.move_to_quarter_points(meshes.rim_nodes(faces[inside][:, :3]))
        self.bottom = np.unique(faces[np.all(self.nodes[faces[:, :3], 2] < 1e-6, axis=1)])
        self.region = regions_of(name, self.nodes[self.tets[:, :4]].mean(axis=1))


def regions_of(name, points):
    region = np.zeros(len(points), int)
    for k, (shape, _, _) in enumerate(CASES[name][1]):
        region[shape.inside(points)] = k + 1
    return region


def materials(name, mesh, even=False):
    ratios = [1.0] + [1.0 if even else ratio for _, ratio, _ in CASES[name][1]]
    return [(calculix.isotropic("M%d" % k, ratio * MODULUS, POISSON), np.flatnonzero(mesh.region == k))
            for k, ratio in enumerate(ratios)]


def file_of(out, name, k, kind=""):
    return pathlib.Path(out) / "closed" / name / ("%02d%s.txt" % (k, kind))


def solve(out, name, k, place):
    kinds = ["", ".even"] if name in EVEN else [""]
    kinds = [kind for kind in kinds if not file_of(out, name, k, kind).exists()]
    if not kinds:
        return
    began = time.time()
    with tempfile.TemporaryDirectory(prefix="hapsim-closed-") as folder:
        folder = pathlib.Path(folder)
        mesh = PlaceMesh(name, place, folder)
        for kind in kinds:
            K = calculix.patch_stiffness(folder, mesh, materials(name, mesh, kind == ".even"), mesh.bottom)
            target = file_of(out, name, k, kind)
            part = target.with_suffix(".part")
            np.savetxt(part, K)
            part.rename(target)
    print("%s %d: %d elements, %.0f s" % (name, k, len(mesh.tets), time.time() - began), flush=True)


def write_surfaces(out, name, smaller=0.0):
    """Of each region; `smaller`: of what lies by so much [mm] inside of it, OUT/closed/CASE-small-N.stl."""
    for k, (shape, _, edge) in enumerate(CASES[name][1]):
        target = pathlib.Path(out) / "closed" / ("%s%s-%d.stl" % (name, "-small" if smaller else "", k + 1))
        shape = shape.smaller(smaller) if smaller else shape
        if target.exists():
            continue
        script = target.with_suffix(".geo")
        script.write_text('SetFactory("OpenCASCADE");\n%sMesh.CharacteristicLengthMax = %g;\n'
                          "Mesh.CharacteristicLengthMin = %g;\nMesh.ScalingFactor = 0.001;\n"
                          % (shape.shape(1), edge / 2, edge / 3))
        subprocess.run(["gmsh", script, "-2", "-format", "stl", "-o", target, "-v", "2"], check=True)
        script.unlink()


def write_body(out, name, edge=4.0):
    """The body with its regions as Gmsh's mesh, physical volumes by number: OUT/closed/CASE.msh [m]."""
    target = pathlib.Path(out) / "closed" / (name + ".msh")
    if target.exists():
        return
    body, regions = CASES[name]
    text = 'SetFactory("OpenCASCADE");\n%s\n' % bodies.shape(body)
    for k, (shape, _, _) in enumerate(regions):
        text += shape.shape(20 + k)
    text += "f() = BooleanFragments{ Volume{1}; Delete; }{ Volume{%s}; Delete; };\n" % ", ".join(
        str(20 + k) for k in range(len(regions)))
    text += "Mesh.CharacteristicLengthMax = %g;\nMesh.CharacteristicLengthMin = %g;\n" % (edge, edge / 2)
    # OpenCASCADE keeps the numbers of the tools and gives what is left of the body another.
    text += "".join('Physical Volume("region_%d", %d) = {%d};\n' % (k + 1, k + 1, 20 + k) for k in range(len(regions)))
    text += "rest() = f();\n" + "".join("rest() -= {%d};\n" % (20 + k) for k in range(len(regions)))
    text += 'Physical Volume("region_0", 1000) = rest();\nMesh.ScalingFactor = 0.001;\nMesh.MshFileVersion = 2.2;\n'
    script = target.with_suffix(".geo")
    script.write_text(text)
    subprocess.run(["gmsh", script, "-3", "-o", target, "-v", "2", "-nt", "1"], check=True)


if __name__ == "__main__":
    out = sys.argv[1]
    for name in sys.argv[2:] or CASES:
        file_of(out, name, 0).parent.mkdir(parents=True, exist_ok=True)
        write_surfaces(out, name)
        for k, place in enumerate(places(name)):
            solve(out, name, k, place)
