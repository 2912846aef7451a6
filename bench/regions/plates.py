"""The blocks with two regions in plan view: where they are pressed, and what lies in them [mm]."""
import numpy as np

import bodies
import variants

TOOL = 4.0
NAMES = ("straight", "s-across", "s-along")
COLUMNS, ROWS = {"straight": 4, "s-across": 4, "s-along": 4}, {"straight": 5, "s-across": 6, "s-along": 7}


def places(name):
    """The thesis's grid of 20 places; of a curve, as many rows, each place off its grid by up to 4 mm."""
    normal, x, y = np.array([0.0, 0.0, 1.0]), 24.0, 40.0
    if name == "straight":
        return [(np.array([x * (i + 1), 25 + y * j, bodies.CUBOID[2]]), normal) for i in range(4) for j in range(5)]
    random = np.random.default_rng({"s-across": 5, "s-along": 6}[name])
    rows = ROWS[name]
    return [(np.round([x * (i + 1) + random.uniform(-4, 4), 20 + 170 * j / (rows - 1) + random.uniform(-4, 4),
                       bodies.CUBOID[2]], 3), normal) for i in range(COLUMNS[name]) for j in range(rows)]


def moduli(name):
    return variants.MODULUS, variants.MODULUS * variants.TWO_PARTS[name][1]
