"""record.py OUT NUMBER...: the bodies' surfaces, the recordings of the phantoms whose stiffnesses are there
(OUT/data/NAME.csv), and what is hidden in each, in a file of its own that only score.py opens (OUT/sealed/NAME.json).

Two presses a place, 3 mm deep in a second: straight, and aslant. What is recorded as the contact point is off."""
import json
import pathlib
import sys

import numpy as np

import make
import phantoms
import solve

DEPTH, SAMPLES, SLANT = 3e-3, 25, 0.5  # [m], over a second; way sideways over that down


def ways(place, number):
    """Unit-time ways of the presses at a place [m]."""
    _, n = place
    side = np.cross(n, [0, 1, 0] if number % 2 else [1, 0, 0])
    return [-DEPTH * n, DEPTH * (SLANT * side / np.linalg.norm(side) - n)]


def visible(pure, empty, noise):
    """Standard deviations that the lumps' forces are from those of the nearest body without, whatever its modulus."""
    pure, empty = np.ravel(pure), np.ravel(empty)
    return float(np.linalg.norm(pure - empty * (empty @ pure) / (empty @ empty)) / noise)


def loaded(out, phantom, bare):
    """Stiffness of the body at its places, and of that without lumps (n, 3, 3): what lumps do is taken from one mesh,
    K = S K_lumps S' with S such that the evened mesh has the stiffness of the empty body's own."""
    K, K0 = [], []
    for place in phantom.places:
        plain = np.loadtxt(solve.file_of(out, bare, place))
        with_lumps = np.loadtxt(solve.file_of(out, phantom, place))
        if phantom.lumps:
            even = np.loadtxt(solve.file_of(out, phantom, place, ".even")) if solve.near_a_lump(phantom, place) else plain
            root = [np.linalg.cholesky((m + m.T) / 2) for m in (plain, even)]
            S = root[0] @ np.linalg.inv(root[1])
            with_lumps = S @ with_lumps @ S.T
        K.append(with_lumps)
        K0.append(plain)
    return np.array(K), np.array(K0)


def write(out, phantom, bare):
    K, K0 = loaded(out, phantom, bare)
    share = np.arange(1, SAMPLES + 1) / SAMPLES
    presses, pure, empty = [], [], []
    for k, place in enumerate(phantom.places):
        for u in ways(place, k):
            presses.append((k, u))
            pure.append(-phantom.scale * share[:, None] * (K[k] @ u))
            empty.append(-phantom.scale * share[:, None] * (K0[k] @ u))
    noise = phantom.noise * max(np.linalg.norm(f, axis=1).max() for f in pure)
    lines = ["# object: %s" % phantom.body, "# tool_radius: %g" % (1e-3 * phantoms.TOOL), "# force_noise: %.6g" % noise,
             "press,t,x,y,z,ux,uy,uz,fx,fy,fz"]
    told = [1e-3 * (p + phantom.random.normal(0, phantoms.OFF, 3)) for p, _ in phantom.places]
    for number, ((k, u), f) in enumerate(zip(presses, pure)):
        f = f + phantom.random.normal(0, noise, f.shape)
        for i in range(SAMPLES):
            lines.append("%d,%.2f,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.5f,%.5f,%.5f"
                         % (number, share[i], *told[k], *(share[i] * u), *f[i]))
    (out / "data" / (phantom.name + ".csv")).write_text("\n".join(lines) + "\n")
    truth = {"body": phantom.body, "places": len(phantom.places), "noise": phantom.noise,
             "sigma": visible(pure, empty, noise), "modulus": phantom.scale * phantoms.MODULUS,
             "lumps": [lump.as_dict() for lump in phantom.lumps]}
    (out / "sealed" / (phantom.name + ".json")).write_text(json.dumps(truth, indent=1) + "\n")


if __name__ == "__main__":
    out = pathlib.Path(sys.argv[1])
    for folder in ("data", "sealed"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    make.write_bodies(out)
    for number in sys.argv[2:]:
        phantom = phantoms.Phantom(int(number))
        if not (out / "sealed" / (phantom.name + ".json")).exists():
            try:
                write(out, phantom, phantoms.Phantom(int(number), bare=True))
            except FileNotFoundError as missing:
                print("%s: skipped, %s has not been computed" % (phantom.name, missing.filename), file=sys.stderr)
