"""closed_motion.py OUT CASE: a motion with three presses a place of 1 mm along x, y and z, on standard output; with a third
argument, a recording of presses on CalculiX's body instead: straight down and aslant to 2 mm, noise of 1 % of the largest
force of a component, of the draw that it says."""
import sys

import numpy as np

import closed

out, name = sys.argv[1:3]
places = closed.places(name)
print("# tool_radius: %g" % (1e-3 * closed.TOOL))
if len(sys.argv) < 4:
    print("press,x,y,z,ux,uy,uz")
    for k, (p, _) in enumerate(places):
        for axis in range(3):
            print("%d,%.9g,%.9g,%.9g,%g,%g,%g" % (3 * k + axis, *(1e-3 * p), *(1e-3 * np.eye(3)[axis])))
else:
    random = np.random.default_rng(int(sys.argv[3]))
    rows = []
    for k, (p, n) in enumerate(places):
        K = np.loadtxt(closed.file_of(out, name, k))
        aside = np.array([1e-3, 0, 0]) if k % 2 else np.array([0, 1e-3, 0])
        for way in (-2e-3 * n, -2e-3 * n + aside):
            rows += [(len(rows) // 10, p, s / 10 * way, -K @ way * s / 10) for s in range(1, 11)]
    noise = 0.01 * max(np.abs(f).max() for *_, f in rows)
    print("# force_noise: %.6g\npress,x,y,z,ux,uy,uz,fx,fy,fz" % noise)
    for press, p, u, f in rows:
        print("%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.6g,%.6g,%.6g" % (press, *(1e-3 * p), *u, *(f + random.normal(0, noise, 3))))
