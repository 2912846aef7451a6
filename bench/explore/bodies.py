"""Twenty bodies, and what each hides: name, shape, rows of the hidden effects, what the verdict should name.

Sizes as in bench/diagnosis; E = 15 kPa and nu = 0.42 everywhere. A lump is named by its centre [m]. Shapes are those
of bench/diagnosis/run.sh: block, phantom (a dome), organ (a lobed dome)."""

ELASTIC = "elastic,0,E,15000\nelastic,0,nu,0.42\n"


def rows(effect, **values):
    return "".join(f"{effect},0,{name},{value}\n" for name, value in values.items())


RELAXING = rows("viscoelastic", E1=6000, tau1=0.6)
FRICTION = rows("friction", mu=0.25)
STIFFENING = rows("hyperelastic", s=0.35, finite=1)
LAG = rows("sensor-lag", tau=0.1, delay=0)
BIAS = rows("sensor-bias", bx=0.05, by=-0.025, bz=0.08)
GAIN = rows("sensor-gain", gx=1.25, gy=1)
HALVES = "elastic,1,E,24000\nregions,0,x1,-0.02\nregions,0,y1,0\nregions,1,x1,0.02\nregions,1,y1,0\n"


def lump(x, y, z, radius, ratio):
    return rows("inclusion", x=x, y=y, z=z, radius=radius, ratio=ratio)


BODIES = [
    # Most different first: where there is no time for all, the first ones are all kinds.
    ("block-relaxing", "block", RELAXING, ["viscoelastic"]),
    ("block-lump", "block", lump(0.020, 0.010, 0.029, 0.006, 6), (0.020, 0.010, 0.029)),
    ("phantom-nothing", "phantom", "", []),
    ("organ-friction", "organ", FRICTION, ["friction"]),
    ("block-halves", "block", HALVES, ["regions"]),
    ("phantom-lump", "phantom", lump(-0.012, 0.008, 0.024, 0.006, 6), (-0.012, 0.008, 0.024)),
    ("phantom-lag", "phantom", LAG, ["sensor-lag"]),
    ("organ-stiffening", "organ", STIFFENING, ["hyperelastic"]),
    ("block-relaxing-friction", "block", RELAXING + FRICTION, ["viscoelastic", "friction"]),
    ("organ-lump", "organ", lump(0.015, -0.010, 0.022, 0.007, 0.15), (0.015, -0.010, 0.022)),
    ("block-base", "block", rows("base", give=0.5, azimuth=0.5, edge=0), ["base"]),
    ("phantom-tip", "phantom", rows("tip", kappa=60), ["tip"]),
    ("organ-gain", "organ", GAIN, ["sensor-gain"]),
    ("block-nothing", "block", "", []),
    ("phantom-relaxing-bias", "phantom", RELAXING + BIAS, ["viscoelastic", "sensor-bias"]),
    ("block-fibres", "block", rows("anisotropic", ratio=2, shear=1, tilt=1.4, azimuth=0.3), ["anisotropic"]),
    ("organ-damper", "organ", rows("damper", c=35, tau=0), ["damper"]),
    ("block-lump-deep", "block", lump(-0.025, -0.012, 0.026, 0.008, 8), (-0.025, -0.012, 0.026)),
    ("phantom-skin", "phantom", rows("layer", thickness=0.002, ratio=4), ["layer"]),
    ("organ-bias", "organ", BIAS, ["sensor-bias"]),
]
