"""The phantoms: what body N is made of, drawn from its number alone.

A row of DESIGN is a kind of phantom; body N is of row N modulo their number, its numbers drawn by N. Lengths in mm."""
import numpy as np

import bodies

TOOL = 4.0
SPACING = 8.0
POISSON = 0.45
MODULUS = 1.0e4  # [Pa] of the body in CalculiX; a recording's own factor is drawn
OFF = 0.2  # standard deviation of a contact point along each axis

# body, places along an axis, noise over the largest force, lumps: (kind, diameter, its top below the surface)
DESIGN = [
    ("cuboid", 5, 0.01, []),
    ("cuboid", 7, 0.01, [("stiff", (12, 12), (2, 5))]),
    ("organ", 5, 0.01, [("stiff", (12, 12), (3, 7))]),
    ("cuboid", 7, 0.01, [("stiff", (12, 12), (7, 10))]),
    ("organ", 7, 0.03, []),
    ("cuboid", 5, 0.01, [("soft", (12, 12), (2, 6))]),
    ("cuboid", 5, 0.03, [("stiff", (12, 12), (2, 6))]),
    ("cuboid", 5, 0.01, [("hollow", (12, 12), (3, 7))]),
    ("cuboid", 7, 0.03, []),
    ("organ", 5, 0.01, [("hollow", (12, 12), (2, 6))]),
    ("cuboid", 5, 0.03, [("stiff", (12, 12), (10, 14))]),
    ("organ", 5, 0.01, []),
    ("organ", 5, 0.01, [("stiff", (12, 12), (7, 10))]),
    ("cuboid", 5, 0.01, [("stiff", (6, 8), (12, 25))]),
    ("organ", 5, 0.03, [("soft", (12, 12), (3, 8))]),
    ("cuboid", 7, 0.01, []),
    ("cuboid", 7, 0.01, [("stiff", (16, 20), (8, 14))]),
    ("cuboid", 7, 0.01, [("stiff", (12, 12), (2, 5)), ("soft", (12, 12), (2, 5))]),
    ("organ", 7, 0.01, []),
    ("cuboid", 5, 0.03, [("stiff", (16, 20), (20, 25))]),
]
RATIO = {"stiff": (3, 10), "soft": (0.1, 0.4), "hollow": (0, 0)}
MIDDLE = {"cuboid": np.array([60.0, 105.0]), "organ": np.array([0.0, 0.0])}


def surface(body, x, y):
    """Point of the upper surface at (x, y), and the unit normal outward."""
    if body == "cuboid":
        return np.array([x, y, bodies.CUBOID[2]]), np.array([0.0, 0.0, 1.0])
    # Where a vertical line leaves the ellipsoid.
    M = bodies.ORGAN_FRAME @ np.diag(bodies.ORGAN_AXES**-2.0) @ bodies.ORGAN_FRAME.T
    d = np.array([x, y, 0.0]) - bodies.ORGAN_MIDDLE
    b, c = M[2] @ d, d @ M @ d - 1
    z = (-b + np.sqrt(b * b - M[2, 2] * c)) / M[2, 2]
    q = d + [0, 0, z]
    n = M @ q
    return bodies.ORGAN_MIDDLE + q, n / np.linalg.norm(n)


def places(body, count):
    """Where it is pressed: a square grid in plan view; smaller grids are the middle of larger ones."""
    at = SPACING * (np.arange(count) - (count - 1) / 2)
    return [surface(body, MIDDLE[body][0] + x, MIDDLE[body][1] + y) for y in at for x in at]


class Lump:
    """centre (3), radius and top (depth below the surface); ratio of its modulus, 0 for a cavity."""

    def __init__(self, kind, body, x, y, diameter, top, ratio):
        p, n = surface(body, x, y)
        self.kind, self.radius, self.top, self.ratio = kind, diameter / 2, top, ratio
        self.depth = top + self.radius
        self.centre = p - self.depth * n

    def as_dict(self):
        return {"kind": self.kind, "centre": self.centre.tolist(), "radius": self.radius, "depth": self.depth,
                "ratio": self.ratio}


class Phantom:
    """Body `number`; with `bare`, the same without its lumps."""

    def __init__(self, number, bare=False):
        self.name = "body-%03d" % number
        self.random = np.random.default_rng(1000 + number)
        self.body, self.count, self.noise, kinds = DESIGN[number % len(DESIGN)]
        self.places = places(self.body, self.count)
        half = SPACING * (self.count - 1) / 2 - 0.75 * SPACING  # not under the outermost presses
        self.lumps = []
        for k, (kind, diameters, tops) in enumerate(kinds):
            x, y = self.random.uniform(-half, half, 2)
            if len(kinds) == 2:  # apart from each other: one in each half
                x = (2 * k - 1) * self.random.uniform(13, half)
            low, high = RATIO[kind]
            ratio = np.exp(self.random.uniform(np.log(low), np.log(high))) if low else 0.0
            self.lumps.append(Lump(kind, self.body, *(MIDDLE[self.body] + [x, y]), self.random.uniform(*diameters),
                                   self.random.uniform(*tops), ratio))
        if bare:
            self.lumps = []
        self.scale = self.random.uniform(0.6, 3.0)  # of the modulus
        # Which solutions of CalculiX it needs: those of an empty body are one for all.
        self.solutions = self.name if self.lumps else "empty-" + self.body
