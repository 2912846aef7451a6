"""The recordings: body, tool radius [mm], variant, laws in the
order in which the force passes them, hidden effects, and what else a recording has."""
import zlib

import bodies
import laws

SLOW = {"holds": (3.0, 5.0)}
MOVES = {  # translation [mm], rotation vector [rad] about the body's middle, from scan to recording
    "cuboid": ((1.5, -2.0, 2.5), (0.06, -0.05, 0.0)),
    "ball": ((4.0, -3.0, 2.0), (0.0, 0.0, 0.0)),
    "organ": ((3.0, -2.5, 1.5), (-0.05, 0.06, 0.05)),
}


def case(name, body, hidden, variant="plain", chain=(), radius=4.0, **more):
    return {"name": name, "body": body, "hidden": hidden, "variant": variant, "chain": list(chain), "radius": radius, **more}


def seed(case):
    """Of its motion and noise."""
    return zlib.crc32(case["name"].encode())


def places(case):
    return bodies.places(case["body"])[: case.get("places", 12)]


def every_case():
    c = []
    for body in ("cuboid", "ball", "organ"):
        c.append(case("null-" + body, body, ""))
        for variant in ("base", "anisotropic", "regions", "inclusion", "layer"):
            c.append(case(variant + "-" + body, body, variant, variant))
        c.append(case("shift-" + body, body, "shift", move=MOVES[body]))
    c += [
        case("null-wide", "organ", "", radius=6.0),
        case("base-wide", "organ", "base", "base", radius=6.0),
        case("stiffening-organ", "organ", "hyperelastic", stiffens=3.0, places=6, aslant=0),
        case("damper-ball", "ball", "damper", chain=[laws.dashpot(4.0)]),
        case("damper-body", "cuboid", "damper", chain=[laws.viscous_body(0.03)]),
        case("relaxing-short", "organ", "viscoelastic", chain=[laws.relaxing([(0.4, 0.05)])], **SLOW),
        case("relaxing-long", "cuboid", "viscoelastic", chain=[laws.relaxing([(0.35, 6.0)])], **SLOW),
        case("relaxing-two", "ball", "viscoelastic", chain=[laws.relaxing([(0.25, 0.15), (0.25, 2.5)])], **SLOW),
        case("lag-organ", "organ", "sensor-lag", chain=[laws.low_pass(0.06)]),
        case("delay-cuboid", "cuboid", "sensor-lag", chain=[laws.delay(0.06)]),
        case("bias-cuboid", "cuboid", "sensor-bias", chain=[laws.offset((0.05, -0.03, 0.08))]),
        case("drift-organ", "organ", "sensor-drift", chain=[laws.offset((0, 0, 0), (5e-5, -3e-5, 1e-4))]),
        case("temperature-ball", "ball", "temperature", chain=[laws.warm(0.03)], swing=6.0),
        case("temperature-small", "cuboid", "temperature", chain=[laws.warm(0.15)], swing=0.45),
        case("ageing-organ", "organ", "softening", chain=[laws.aged(2e-4)], swing=0.45),
        case("ageing-cuboid", "cuboid", "softening", chain=[laws.aged(-2e-4)]),
        case("rotation-ball", "ball", "sensor-rotation", chain=[laws.askew([0.12, -0.08, 0.05])]),
        case("rotation-cuboid", "cuboid", "sensor-rotation", chain=[laws.askew([-0.1, 0.1, 0])]),
        case("gain-organ", "organ", "sensor-gain", chain=[laws.gains((1.3, 1, 1))]),
        case("gain-cuboid", "cuboid", "sensor-gain", chain=[laws.gains((1, 1, 0.75))]),
        case("friction-cuboid", "cuboid", "friction", chain=[laws.slipping(0.25)]),
        case("friction-ball", "ball", "friction", chain=[laws.slipping(0.3)]),
        case("worn-organ", "organ", "softening", chain=[laws.worn(0.3)]),
        case("mullins-cuboid", "cuboid", "softening", chain=[laws.mullins(0.2)]),
        case("curve-ball", "ball", "sensor-curve", chain=[laws.saturating(1.5)]),
        case("dead-organ", "organ", "deadband", chain=[laws.dead(0.12)]),
        case("tare-cuboid", "cuboid", "tare", chain=[laws.tares(0.06, 5)]),
        case("relaxing+regions", "cuboid", "viscoelastic regions", "regions", [laws.relaxing([(0.35, 0.7)])], **SLOW),
        case("bias+layer", "ball", "layer sensor-bias", "layer", [laws.offset((0.04, 0.05, -0.06))]),
        case("relaxing+rotation", "organ", "viscoelastic sensor-rotation",
             chain=[laws.relaxing([(0.4, 1.0)]), laws.askew([0.1, 0.08, 0])], **SLOW),
        case("temperature+gain", "ball", "temperature sensor-gain", chain=[laws.warm(0.03), laws.gains((1, 0.75, 1))], swing=6.0),
        case("relaxing+base", "cuboid", "viscoelastic base", "base", [laws.relaxing([(0.3, 0.5)])], **SLOW),
        case("relaxing+shift", "organ", "viscoelastic shift", chain=[laws.relaxing([(0.3, 0.5)])], move=MOVES["organ"], **SLOW),
        case("lag+inclusion", "organ", "sensor-lag inclusion", "inclusion", [laws.low_pass(0.05)]),
        case("drift+anisotropic", "cuboid", "anisotropic sensor-drift", "anisotropic", [laws.offset((0, 0, 0.03), (4e-5, 3e-5, -6e-5))]),
        case("damper+bias", "organ", "damper sensor-bias", chain=[laws.dashpot(4.0), laws.offset((0.03, -0.05, 0.05))]),
        case("friction+regions", "organ", "friction regions", "regions", [laws.slipping(0.3)]),
    ]
    return c
