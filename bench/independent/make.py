"""make.py OUT [NAME...]: surfaces and scans of the bodies, and every recording whose stiffnesses are
there, as OUT/data/NAME.csv; OUT/truth.csv says what is hidden."""
import pathlib
import subprocess
import sys

import numpy as np

import bodies
import cases
import finite
import stiffnesses


def write_bodies(out):
    for body in bodies.BODIES:
        scan = out / (body + "_scan.csv")
        if not scan.exists():
            rows = 1e-3 * bodies.scan(body)
            scan.write_text("x,y,z\n" + "\n".join("%.6f,%.6f,%.6f" % tuple(r) for r in rows) + "\n")
        surface = out / (body + ".stl")
        if not surface.exists():
            script = out / (body + ".geo")
            script.write_text('SetFactory("OpenCASCADE");\n%s\nMesh.CharacteristicLengthMax = 3;\n'
                              "Mesh.ScalingFactor = 0.001;\n" % bodies.shape(body))
            subprocess.run(["gmsh", script, "-2", "-format", "stl", "-o", surface, "-v", "2"], check=True)
            script.unlink()


def forces(case, presses, out):
    """The body's forces on the tool, press by press."""
    if "stiffens" in case:
        return finite.forces(case, presses, out)
    K = stiffnesses.load(out, case["body"], case["radius"], case["variant"])
    return [-p.u @ K[p.place].T for p in presses]


def write(case, out):
    name, body = case["name"], case["body"]
    seed = cases.seed(case)
    random = np.random.default_rng(seed)
    places = cases.places(case)
    presses = finite.presses(case)
    swing = case.get("swing")
    for p in presses:
        p.temperature = 22 + (swing or 0) * np.sin(2 * np.pi * p.t / 800)
    measured = []
    for f, p in zip(forces(case, presses, out), presses):
        for law in case["chain"]:
            f = law(f, p)
        measured.append(f)
    noise = round(0.01 * max(np.linalg.norm(f, axis=1).max() for f in measured), 4)
    move, turn = case.get("move", ((0, 0, 0), (0, 0, 0)))
    R, middle = bodies.rotation(turn), np.mean([p for p, _ in places], axis=0)
    lines = ["# object: " + body, "# tool_radius: %g" % (1e-3 * case["radius"]), "# force_noise: %g" % noise,
             "press,t,x,y,z,ux,uy,uz,fx,fy,fz" + (",temp" if swing else "")]
    for k, (p, f) in enumerate(zip(presses, measured)):
        x = 1e-3 * (middle + R @ (places[p.place][0] - middle) + move)
        u, f = p.u @ R.T, f @ R.T + random.normal(0, noise, f.shape)
        heat = p.temperature + random.normal(0, 0.05, len(p.t))
        for i in range(len(p.t)):
            row = "%d,%.2f,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.4f,%.4f,%.4f" % (k, p.t[i], *x, *u[i], *f[i])
            lines.append(row + (",%.2f" % heat[i] if swing else ""))
    (out / "data" / (name + ".csv")).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    out, wanted = pathlib.Path(sys.argv[1]), sys.argv[2:]
    (out / "data").mkdir(parents=True, exist_ok=True)
    write_bodies(out)
    truth = ["name,body,hidden"]
    for case in cases.every_case():
        truth.append("%s,%s,%s" % (case["name"], case["body"], case["hidden"] or "nothing"))
        if wanted and case["name"] not in wanted or (out / "data" / (case["name"] + ".csv")).exists():
            continue
        try:
            write(case, out)
        except FileNotFoundError as missing:
            print("%s: skipped, %s has not been computed" % (case["name"], missing.filename), file=sys.stderr)
    (out / "truth.csv").write_text("\n".join(truth) + "\n")
