"""The bodies as exact solids [mm]: their shape for Gmsh, places on their upper side, scans of it.

Every body is bonded at z = 0. A place is (point, outward unit normal)."""
import numpy as np

BODIES = ("cuboid", "ball", "organ")
CUBOID = (120.0, 210.0, 60.0)
BALL_MIDDLE, BALL_RADIUS = np.array([0.0, 0.0, 35.0]), 50.0
ORGAN_MIDDLE, ORGAN_AXES = np.array([0.0, 0.0, 22.0]), np.array([58.0, 41.0, 33.0])
ORGAN_TILT, ORGAN_TURN = 0.17, 0.35  # about y, then about z [rad]


def rotation(vector):
    """Matrix of a rotation vector (Euler-Rodrigues)."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = np.asarray(vector) / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


ORGAN_FRAME = rotation([0, 0, ORGAN_TURN]) @ rotation([0, ORGAN_TILT, 0])


def shape(body, skin=0.0, number=1):
    """The body for Gmsh as that volume; with a skin, what is below it."""
    above = ("Box(%d) = {-200, -200, 0, 400, 400, 400};\nBooleanIntersection{ Volume{%d}; Delete; }{ Volume{%d}; Delete; }"
             % (number + 8, number, number + 8))
    if body == "cuboid":
        x, y, z = CUBOID
        return "Box(%d) = {%g, %g, 0, %g, %g, %g};" % (number, skin, skin, x - 2 * skin, y - 2 * skin, z - skin)
    if body == "ball":
        return "Sphere(%d) = {%g, %g, %g, %g};\n" % (number, *BALL_MIDDLE, BALL_RADIUS - skin) + above
    return ("Sphere(%d) = {0, 0, 0, 1};\n" % number
            + "Dilate{ {0, 0, 0}, {%g, %g, %g} }{ Volume{%d}; }\n" % (*(ORGAN_AXES - skin), number)
            + "Rotate{ {0, 1, 0}, {0, 0, 0}, %g }{ Volume{%d}; }\n" % (ORGAN_TILT, number)
            + "Rotate{ {0, 0, 1}, {0, 0, 0}, %g }{ Volume{%d}; }\n" % (ORGAN_TURN, number)
            + "Translate{ %g, %g, %g }{ Volume{%d}; }\n" % (*ORGAN_MIDDLE, number) + above)


def on_ball(direction):
    n = np.asarray(direction) / np.linalg.norm(direction)
    return BALL_MIDDLE + BALL_RADIUS * n, n


def on_organ(direction):
    """Where a ray from the middle leaves the ellipsoid."""
    d = ORGAN_FRAME.T @ (np.asarray(direction) / np.linalg.norm(direction))
    q = d / np.linalg.norm(d / ORGAN_AXES)
    n = ORGAN_FRAME @ (q / ORGAN_AXES**2)
    return ORGAN_MIDDLE + ORGAN_FRAME @ q, n / np.linalg.norm(n)


def places(body, count=12):
    """Pressed places, the same at every call: far enough from each other and from edges."""
    random = np.random.default_rng({"cuboid": 11, "ball": 12, "organ": 13}[body])
    chosen = []
    while len(chosen) < count:
        if body == "cuboid":
            p = np.array([random.uniform(14, 106), random.uniform(14, 196), CUBOID[2]])
            n = np.array([0.0, 0.0, 1.0])
        else:
            tilt, around = np.arccos(random.uniform(0.55, 1)), random.uniform(0, 2 * np.pi)
            d = [np.sin(tilt) * np.cos(around), np.sin(tilt) * np.sin(around), np.cos(tilt)]
            p, n = on_ball(d) if body == "ball" else on_organ(d)
        if p[2] > 20 and all(np.linalg.norm(p - q) > 14 for q, _ in chosen):
            chosen.append((np.round(p, 3), n))
    return chosen


def depth_below(body, points):
    """Distance to the free surface [mm], (n) of points (n, 3); to first order on the organ."""
    if body == "cuboid":
        x, y, z = points.T
        return np.min([x, CUBOID[0] - x, y, CUBOID[1] - y, CUBOID[2] - z], axis=0)
    if body == "ball":
        return BALL_RADIUS - np.linalg.norm(points - BALL_MIDDLE, axis=1)
    q = (points - ORGAN_MIDDLE) @ ORGAN_FRAME
    level = np.linalg.norm(q / ORGAN_AXES, axis=1)
    return (1 - level) * level / np.maximum(1e-9, np.linalg.norm(q / ORGAN_AXES**2, axis=1))


def scan(body, count=2000, noise=0.2, gross=0.01):
    """Points of the upper and side surface with noise, one in a hundred far off [mm]."""
    random = np.random.default_rng(21)
    points = []
    while len(points) < count:
        if body == "cuboid":
            x, y, z = (random.uniform(0, s) for s in CUBOID)
            a, b, c = CUBOID
            side = random.choice(5, p=np.array([a * b, a * c, a * c, b * c, b * c]) / (a * b + 2 * a * c + 2 * b * c))
            p = np.array([[x, y, c], [x, 0, z], [x, b, z], [0, y, z], [a, y, z]][side])
        else:
            d = random.normal(size=3)
            p, _ = on_ball(d) if body == "ball" else on_organ(d)
            if p[2] < 0.5:
                continue
        far = random.uniform() < gross
        points.append(p + random.normal(size=3) * (4 if far else noise))
    return np.array(points)
