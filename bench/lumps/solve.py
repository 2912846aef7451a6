"""solve.py OUT NUMBER...: the contact stiffness of every pressed place of the phantoms, by CalculiX.

Kept in OUT/stiffness/NAME/X-Y.txt (place in plan view, 3 x 3 [N/m]) and not computed again. A mesh a place, by Gmsh:
second-order tetrahedra, the patch of the tool and the lumps' surfaces imprinted, graded to both. Elements that are
finer about a lump make the body softer by themselves (0.4 % were seen), which would look like a lump: near one the
same mesh is solved with the lump's modulus evened out as well (X-Y.even.txt), and record.py takes that out."""
import pathlib
import subprocess
import sys
import tempfile
import time
import types

import numpy as np

import bodies
import calculix
import meshes
import phantoms

RIM, GROWTH = 0.5, 0.6  # edge length at the tool's rim [mm], and its growth with the distance
LUMP_EDGES = 3  # edges in a lump's radius
# A polyhedron of such edges whose corners lie on a ball is smaller; they lie outside of it by as much.
SWELL = 1 + 1 / (8 * LUMP_EDGES**2)


def ball_field(number, lump):
    lines = ["Field[%d] = Ball;" % number]
    for name, value in zip(("XCenter", "YCenter", "ZCenter"), lump.centre):
        lines.append("Field[%d].%s = %.9g;" % (number, name, value))
    for name, value in (("Radius", 1.05 * lump.radius), ("Thickness", 2 * lump.radius),
                        ("VIn", lump.radius / LUMP_EDGES), ("VOut", 14)):
        lines.append("Field[%d].%s = %.9g;" % (number, name, value))
    return "\n".join(lines) + "\n"


def geometry(body, place, lumps):
    p, n = place
    a, b = p - n, 2 * n
    away = "((x-(%.9g))*(%.9g)+(y-(%.9g))*(%.9g)+(z-(%.9g))*(%.9g))" % (p[0], n[0], p[1], n[1], p[2], n[2])
    square = "((x-(%.9g))^2+(y-(%.9g))^2+(z-(%.9g))^2)" % tuple(p)
    aside = "sqrt(abs(%s-%s^2))" % (square, away)
    size = "%g+%g*sqrt((%s-%g)^2+%s^2)" % (RIM, GROWTH, aside, phantoms.TOOL, away)
    spheres, fields, names = "", "", ["part()"]
    for k, lump in enumerate(lumps):
        spheres += "Sphere(%d) = {%.9g, %.9g, %.9g, %.9g};\n" % (20 + k, *lump.centre, SWELL * lump.radius)
        names.append(str(20 + k))
        fields += ball_field(10 + k, lump)
    numbers = ", ".join(["1"] + [str(10 + k) for k in range(len(lumps))])
    return """SetFactory("OpenCASCADE");
%s
Cylinder(2) = {%.9g, %.9g, %.9g, %.9g, %.9g, %.9g, %g};
part() = BooleanIntersection{ Volume{1}; }{ Volume{2}; Delete; };
%sBooleanFragments{ Volume{1}; Delete; }{ Volume{%s}; Delete; }
Field[1] = MathEval;
Field[1].F = "%s";
%sField[3] = Min;
Field[3].FieldsList = {%s};
Background Field = 3;
""" % (bodies.shape(body), *a, *b, phantoms.TOOL, spheres, ", ".join(names), size, fields, numbers) + meshes.SETTINGS


class PlaceMesh:
    """nodes (n, 3) [mm], tets (m, 10), inside: the lump that each is in or -1 (m), patch and bottom: indices of nodes."""

    def __init__(self, body, place, lumps, folder):
        script, result = folder / "mesh.geo", folder / "mesh.msh"
        script.write_text(geometry(body, place, lumps))
        done = subprocess.run(["gmsh", script, "-3", "-o", result, "-v", "2", "-nt", "1"], capture_output=True, text=True)
        if done.returncode != 0 or not result.exists():
            raise RuntimeError("gmsh failed on %s: %s" % (script, done.stdout + done.stderr))
        self.nodes, self.tets, _ = meshes.read_msh(result)
        result.unlink()
        middles = self.nodes[self.tets[:, :4]].mean(axis=1)
        self.inside = np.full(len(self.tets), -1)
        a, b, c, d = (self.nodes[self.tets[:, k]] for k in range(4))
        volumes = np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)) / 6
        for k, lump in enumerate(lumps):
            inside = np.linalg.norm(middles - lump.centre, axis=1) < lump.radius
            share = volumes[inside].sum() / (4 / 3 * np.pi * lump.radius**3)
            if abs(share - 1) > 0.02:
                raise RuntimeError("%s: a lump has %.3f of its volume" % (script, share))
            self.inside[inside] = k
        p, n = place
        faces = meshes.boundary_faces(self.tets)
        corners = self.nodes[faces[:, :3]] - p
        away = corners @ n
        aside = np.linalg.norm(corners - away[..., None] * n, axis=2)
        inside = np.all((aside < phantoms.TOOL + 1e-3) & (np.abs(away) < phantoms.TOOL / 2), axis=1)
        self.patch = np.unique(faces[inside])
        edges = self.nodes[faces[inside]]
        area = 0.5 * np.linalg.norm(np.cross(edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0]), axis=1).sum()
        if not 0.97 < area / (np.pi * phantoms.TOOL**2) < 1.1:
            raise RuntimeError("%s: the patch has %.3g mm2" % (script, area))
        self.bottom = np.unique(faces[np.all(self.nodes[faces[:, :3], 2] < 1e-6, axis=1)])


def stiffness(folder, mesh, ratios):
    """K (3, 3) [N/m] with lumps of these ratios: force on the tool = -K u."""
    materials = [(calculix.isotropic("A", phantoms.MODULUS, phantoms.POISSON), np.flatnonzero(mesh.inside < 0))]
    for k, ratio in enumerate(ratios):
        if ratio > 0:
            name = chr(ord("B") + k)
            materials.append((calculix.isotropic(name, ratio * phantoms.MODULUS, phantoms.POISSON),
                              np.flatnonzero(mesh.inside == k)))
    holes = [k for k, ratio in enumerate(ratios) if ratio == 0]
    kept = ~np.isin(mesh.inside, holes)
    numbers = np.cumsum(kept) - 1
    materials = [(text, numbers[elements]) for text, elements in materials]
    return calculix.patch_stiffness(folder, types.SimpleNamespace(nodes=mesh.nodes, tets=mesh.tets[kept], patch=mesh.patch), materials,
                                    mesh.bottom)


def file_of(out, phantom, place, kind=""):
    return pathlib.Path(out) / "stiffness" / phantom.solutions / ("%.3f-%.3f%s.txt" % (place[0][0], place[0][1], kind))


FAR = 25.0  # [mm] in plan view from a lump: there its mesh is the same as without (0.04 % were seen)


def near_a_lump(phantom, place):
    return any(np.hypot(*(place[0] - lump.centre)[:2]) < FAR for lump in phantom.lumps)


def solve(out, phantom):
    for place in phantom.places:
        wanted = [""] + ([".even"] if near_a_lump(phantom, place) else [])
        wanted = [kind for kind in wanted if not file_of(out, phantom, place, kind).exists()]
        if not wanted:
            continue
        with tempfile.TemporaryDirectory(prefix="hapsim-lumps-") as folder:
            folder = pathlib.Path(folder)
            mesh = PlaceMesh(phantom.body, place, phantom.lumps, folder)
            for kind in wanted:
                K = stiffness(folder, mesh, [lump.ratio if kind == "" else 1.0 for lump in phantom.lumps])
                target = file_of(out, phantom, place, kind)
                target.parent.mkdir(parents=True, exist_ok=True)
                part = target.with_suffix(".part")
                np.savetxt(part, K)
                part.rename(target)


if __name__ == "__main__":
    for number in sys.argv[2:]:
        phantom, began = phantoms.Phantom(int(number)), time.time()
        solve(sys.argv[1], phantom)
        solve(sys.argv[1], phantoms.Phantom(int(number), bare=True))
        print("%s: %d places, %.0f s" % (phantom.name, len(phantom.places), time.time() - began), flush=True)
