"""Regular grids of places on a surface (OFF [m], triangles), pressed in the usual way."""

import math

# Of the surface's half extents in plan view: cells of the grid fill that. A dome is too steep beyond.
REACH = {"block": 1.0, "phantom": 0.65, "organ": 0.6}


def read_off(path):
    numbers = open(path).read().split()[1:]
    points, faces = int(numbers[0]), int(numbers[1])
    values = numbers[3:]
    vertices = [tuple(map(float, values[3 * k : 3 * k + 3])) for k in range(points)]
    rest = values[3 * points :]
    return vertices, [tuple(map(int, rest[4 * k + 1 : 4 * k + 4])) for k in range(faces)]


def on_top(surface, px, py):
    """The highest point there and the outward normal of its face."""
    vertices, faces = surface
    best = None
    for f in faces:
        a, b, c = (vertices[i] for i in f)
        det = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if det <= 1e-14:
            continue
        s = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) / det
        t = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) / det
        if s < -1e-9 or t < -1e-9 or s + t > 1 + 1e-9:
            continue
        z = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2])
        u, v = [[q[i] - a[i] for i in range(3)] for q in (b, c)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], det)
        size = math.sqrt(sum(x * x for x in n))
        if best is None or z > best[0][2]:
            best = ((px, py, z), tuple(x / size for x in n))
    return best


def places(surface, shape, side):
    low = [min(v[c] for v in surface[0]) for c in (0, 1)]
    high = [max(v[c] for v in surface[0]) for c in (0, 1)]
    at = []
    for j in range(side):
        for i in range(side):
            p = [(low[c] + high[c]) / 2 + REACH[shape] * (high[c] - low[c]) / 2 * ((2 * k + 1) / side - 1)
                 for c, k in ((0, i), (1, j))]
            at.append(on_top(surface, *p))
    return at


def press(number, start, place, depth, way, hold, slide, turn):
    """As `rich` of bench/diagnosis/presses.awk: the way in and out through the air, a slide at depth."""
    point, n = place
    a, b = (n[2], 0, -n[0]), (0, n[2], -n[1])
    side = [math.cos(turn) * a[i] + math.sin(turn) * b[i] for i in range(3)]
    size = math.sqrt(sum(x * x for x in side))
    moving = 0.5 if slide else 0
    end = way + moving + hold
    rows, count = [], int((end + 1.1) / 0.02)
    for i in range(count):
        t, aside = 0.02 * i - 0.3, 0
        if t < 0:
            q = 2 * t / 3
        elif t < way:
            q = t / way
        elif t < way + moving:
            q, aside = 1, slide * (t - way) / moving
        elif t < end:
            q, aside = 1, slide
        elif t < end + 0.5:
            q = 1 - (t - end) / 0.5
            aside = slide * q
        else:
            q = -(t - end - 0.5) / 0.3 * 0.4
        u = [depth * (aside * side[c] / size - q * n[c]) for c in range(3)]
        rows.append("%d,%.2f,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%d" % (number, start + t, *point, *u, q >= 0))
    return rows, start + end + 12


def motion(surface, shape, side, kinds_a_place):
    """Slow, fast with a hold, sideways at depth: all three at every place, or one at each in turn."""
    at = places(surface, shape, side)
    lines, start, number = ["# tool_radius: 0.004", "press,t,x,y,z,ux,uy,uz,contact"], 1.0, 0
    for kind in range(kinds_a_place):
        for k, place in enumerate(at):
            which = kind if kinds_a_place == 3 else k % 3
            number += 1
            rows, start = press(number, start, place, 2.5e-3 * (1 + ((k * 7) % 12) / 11),
                                2 if which == 0 else 0.25, 0.4 if which == 0 else 2,
                                0.6 if which == 2 else 0, 2.4 * number)
            lines += rows
    return "\n".join(lines) + "\n"
