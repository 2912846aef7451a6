"""What a body may be made of: CalculiX's materials by elements' centroids, support, axes."""
import numpy as np

import bodies
import calculix

MODULUS = 2.0e4  # [Pa] of what is not changed
POISSON = {"cuboid": 0.40, "ball": 0.43, "organ": 0.46}

# middle [mm], radius [mm], modulus over that around it
INCLUSION = {
    "cuboid": (np.array([48.0, 112.0, 43.0]), 10.0, 8.0),
    "ball": (np.array([14.0, 2.0, 62.0]), 11.0, 8.0),
    "organ": (np.array([12.0, 6.0, 36.0]), 9.0, 0.15),
}
SKIN = {"cuboid": (2.5, 5.0), "ball": (2.0, 8.0), "organ": (3.0, 0.3)}  # thickness [mm], ratio
FIBRES = {"cuboid": (2.6, (1, 0, 0)), "ball": (2.6, (0.6, 0.0, 0.8)), "organ": (0.45, (0, 1, 0))}
STIFFER = {"cuboid": 2.0, "ball": 1.7, "organ": 2.5}
# Two regions by a curve in plan view: what is positive (n) of x, y [mm] in the stiffer one, the ratio of the
# moduli, Poisson's ratio, and the same for Gmsh's fields.
TWO_PARTS = {
    "straight": (lambda x, y: y - 100, 2.0, 0.30, "(y-100)"),
    "s-across": (lambda x, y: y - 105 - 20 * np.sin(2 * np.pi * x / 120), 2.0, 0.40,
                 "(y-105-20*sin(2*3.14159265*x/120))"),
    "s-along": (lambda x, y: x - 60 - 18 * np.sin(2 * np.pi * y / 160 + 0.6), 2.5, 0.40,
                "(x-60-18*sin(2*3.14159265*y/160+0.6))"),
}


def stiffer_part(body, x):
    """Where (n, 3) [mm] the modulus is another: boundaries curved in plan view."""
    if body == "cuboid":
        return x[:, 0] > 62 + 14 * np.sin(0.05 * x[:, 1] + 1)
    if body == "ball":
        return x[:, 1] < -3 + 0.02 * x[:, 0] ** 2 - 8
    return np.hypot(x[:, 0] - 22, x[:, 1] - 4) < 21


def axes(direction):
    """CalculiX's *ORIENTATION whose third axis is `direction`."""
    c = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    a = np.cross(c, [0, 0, 1] if abs(c[2]) < 0.9 else [1, 0, 0])
    a /= np.linalg.norm(a)
    return ", ".join("%.9g" % v for v in [*a, *np.cross(c, a)])


def build(name, body, mesh):
    """(materials, fixed nodes, orientation) for calculix.stiffness."""
    every = np.arange(len(mesh.tets))
    nu = TWO_PARTS[name][2] if name in TWO_PARTS else POISSON[body]

    def two_parts(inside, ratio):
        return [(calculix.isotropic("A", MODULUS, nu), every[~inside]),
                (calculix.isotropic("B", MODULUS * ratio, nu), every[inside])]

    if name == "plain":
        return [(calculix.isotropic("A", MODULUS, nu), every)], mesh.bottom, ""
    if name == "regions":
        return two_parts(stiffer_part(body, mesh.centroids), STIFFER[body]), mesh.bottom, ""
    if name in TWO_PARTS:
        level, ratio, _, _ = TWO_PARTS[name]
        return two_parts(level(*mesh.centroids[:, :2].T) > 0, ratio), mesh.bottom, ""
    if name == "layer":
        # The mesh has the skin's inner face: whole volumes are on one side of it.
        thickness, ratio = SKIN[body]
        shallow = bodies.depth_below(body, mesh.centroids) < thickness
        skin = [v for v in np.unique(mesh.volumes) if np.mean(shallow[mesh.volumes == v]) > 0.5]
        return two_parts(np.isin(mesh.volumes, skin), ratio), mesh.bottom, ""
    if name == "inclusion":
        middle, radius, ratio = INCLUSION[body]
        return two_parts(np.linalg.norm(mesh.centroids - middle, axis=1) < radius, ratio), mesh.bottom, ""
    if name == "anisotropic":
        ratio, direction = FIBRES[body]
        return [(calculix.transverse("A", MODULUS, ratio, nu), every)], mesh.bottom, axes(direction)
    if name == "base":
        x = mesh.nodes[mesh.bottom]
        middle = 0.5 * (mesh.nodes.min(axis=0) + mesh.nodes.max(axis=0))
        bonded = (x - middle)[:, 0] + 0.4 * (x - middle)[:, 1] > 0
        return [(calculix.isotropic("A", MODULUS, nu), every)], mesh.bottom[bonded], ""
    raise ValueError("no variant " + name)
