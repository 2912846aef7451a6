#!/usr/bin/env python3
"""unseen.py BIN OUT [BODY...]: how well places that nobody has pressed are foretold after a closed loop (hs-plan with
the simulated robot) whose goal was just that, on bodies of two and three moduli.

The loop runs with --goal unseen=2 (RATIO); then hs-identify --effects auto --refine-boundary 8 fits what it has recorded,
and foretells straight presses at 36 places of a regular grid (6 x 6), those left out that lie within a tool's radius of one
that was pressed. A line a body: presses, what hs-plan says, and the root mean square error of the foretold forces over the noise
(0.01 N, in the measurement too: 1 is perfect), of all places and of the worst one; how many lie within the band that
the model states (unseen_band); the same after a regular grid of as many presses (one a place in turn), which is what
the loop must beat. Forces, scans and shapes as in run.py; of regions-cuboid, -ball and -organ (those of
bench/independent, from their STL) forces by CalculiX (calculix_robot.py), unseen places the twelve pressed there, and no
grid. OUT keeps everything, and what is there is not made again.
Recorded in bench/results/explore-unseen.txt (bench/record.sh)."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
import grids  # noqa: E402
import run  # noqa: E402
from bodies import ELASTIC, HALVES  # noqa: E402

RATIO = os.environ.get("RATIO", "2")
MOST, RADIUS, NOISE, SIDE = 60, 0.004, 0.01, 6


def regions(moduli, *points):
    """Rows of moduli [Pa] of region 1, 2, ... and of key points (region, x, y [m])."""
    rows = "".join(f"elastic,{1 + k},E,{value}\n" for k, value in enumerate(moduli))
    number = {}
    for region, x, y in points:
        number[region] = k = number.get(region, 0) + 1
        rows += f"regions,{region},x{k},{x}\nregions,{region},y{k},{y}\n"
    return rows


def along(curve, gap=0.004):
    """Key points on both sides of the curve y = curve(x)."""
    at = [-0.054 + 0.006 * k for k in range(19)]
    return [(0, x, curve(x) - gap) for x in at] + [(1, x, curve(x) + gap) for x in at]


BODIES = {
    "block-halves": ("block", HALVES),
    "phantom-slanted": ("phantom", regions([30000], (0, -0.01, -0.008), (1, 0.01, 0.008))),
    "organ-soft": ("organ", regions([8000], (0, -0.012, 0.004), (1, 0.012, -0.004))),
    "block-wave": ("block", regions([30000], *along(lambda x: 0.012 * math.sin(x / 0.018)))),
    "block-strip": ("block", regions([30000, 9000], (0, -0.03, 0), (1, 0, 0), (2, 0.03, 0))),
    "phantom-corner": ("phantom", regions([35000], *[(0, 0.012 + 0.02 * math.cos(a), 0.02 * math.sin(a))
                                                      for a in (1.0, 2.1, 3.14, 4.2, 5.3)], (1, 0.014, 0))),
}


CALCULIX = ("cuboid", "ball", "organ")
HERE = Path(__file__).resolve().parent


def calculix_unseen(body):
    """The twelve places of bench/independent, pressed straight."""
    script = f"import bodies; print(*[(*(1e-3 * p), *n) for p, n in bodies.places('{body}')], sep='\\n')"
    told = subprocess.run(["/usr/bin/python3", "-c", script], env={**os.environ, "PYTHONPATH": str(HERE.parent / "independent")},
                          check=True, capture_output=True, text=True).stdout
    places = [[float(x) for x in line.strip("()").split(", ")] for line in told.split("\n") if line]
    return straight([(p[:3], p[3:]) for p in places])


def table(path):
    lines = [line for line in open(path) if line.strip() and not line.startswith("#")]
    names = lines[0].strip().split(",")
    return [dict(zip(names, line.strip().split(","))) for line in lines[1:]]


def metadata(path):
    return dict(line[1:].strip().split(": ", 1) for line in open(path) if line.startswith("#") and ": " in line)


def place_of(row):
    return tuple(float(row[c]) for c in "xyz")


def straight(places):
    lines, start = ["# tool_radius: 0.004", "press,t,x,y,z,ux,uy,uz,contact"], 1.0
    for k, place in enumerate(places):
        rows, start = grids.press(1 + k, start, place, 3.5e-3, 1, 0.3, 0, 0)
        lines += rows
    return "\n".join(lines) + "\n"


def foretold(work, name, data, body):
    """(error over noise at all unseen places, at the worst, how many within the band, of how many, the band)."""
    folder = work / name
    folder.mkdir(exist_ok=True)
    if not (folder / "foretold.csv").exists():
        run.shell(f"cd {folder}; hs-identify -q {data} --body {body} --effects auto --refine-boundary 8 --threads 1 -o model.csv;"
                  f" hs-simulate -q ../unseen.csv --body {body} --model model.csv -o foretold.csv")
    said = metadata(folder / "model.csv")
    band = float(said.get("unseen_band", "nan"))
    pressed = {place_of(r) for r in table(data)}
    sums = {}
    for measured, told in zip(table(work / "unseen.csv"), table(folder / "foretold.csv")):
        if measured["contact"] != "1" or min(math.dist(place_of(measured), p) for p in pressed) < RADIUS:
            continue
        place = sums.setdefault(place_of(measured), [0, 0, 0])
        for c in ("fx", "fy", "fz"):
            place[0] += (float(measured[c]) - float(told[c])) ** 2
            place[1] += float(measured[c]) ** 2
            place[2] += 1
    within = sum(max(0, e - n * NOISE**2) <= band**2 * f for e, f, n in sums.values())
    total = [sum(s[k] for s in sums.values()) for k in range(3)]
    worst = max(math.sqrt(e / n) for e, f, n in sums.values())
    return math.sqrt(total[0] / total[2]) / NOISE, worst / NOISE, within, len(sums), band


def loop(work, body, robot):
    """Six first, then two at a time; hs-plan's last answer."""
    folder = work / "loop"
    folder.mkdir(exist_ok=True)
    data = folder / "data.csv"
    data.touch()
    for k in range(MOST):
        plan, motion = folder / f"plan-{k}.json", folder / f"motion-{k}.csv"
        if not plan.exists():
            subprocess.run(["hs-plan", "-q", data, "--body", body, "--tool-radius", "4mm", "--goal", "unseen=" + RATIO,
                            "--presses", "6" if k == 0 else "2", "--most-presses", str(MOST), "--threads", "1",
                            "--json", str(plan) + ".new", "-o", motion], check=True)
            os.replace(str(plan) + ".new", plan)
        answer = json.loads(plan.read_text())
        if answer["reached"] or answer["ended"]:
            return answer
        if not (folder / f"done-{k}").exists():
            rows = "cat" if k == 0 else "grep '^[0-9]'"
            run.shell(f"{robot} {motion} | {rows} >{folder}/new.csv; cat {folder}/new.csv >>{data}; touch {folder}/done-{k}")
    return answer


def own_body(out, work, name):
    """(The body from a scan, what presses the true one, how to press it on a grid of a side.)"""
    shape, rows = BODIES[name]
    shape_folder = run.shape_of(out, shape)
    (work / "truth").mkdir(parents=True, exist_ok=True)
    run.shell(f"cp {shape_folder}/true.ply {work}/truth/body.ply")
    (work / "truth/model.csv").write_text("effect,region,parameter,value\n" + ELASTIC + rows)
    surface = grids.read_off(shape_folder / "surface.off")
    truth = f"--body {work}/truth/body.ply --model {work}/truth/model.csv --rim-edge $RIM --add-noise {NOISE}"

    def press(motion, seed, to):
        if not to.exists():
            (work / "motion.csv").write_text(motion)
            run.shell(f"hs-simulate -q {work}/motion.csv {truth} --seed {seed} -o {to}")

    press(straight(grids.places(surface, shape, SIDE)), 5, work / "unseen.csv")

    def grid(side):
        press(grids.motion(surface, shape, side, 1), 12, work / f"grid-{side}.csv")

    return shape_folder / "body.ply", f"{run.SHARE}/explore/robot.sh {work}/truth", grid


def calculix_body(out, work, name):
    body = out / (name + ".ply")
    work.mkdir(exist_ok=True)
    robot = f"/usr/bin/python3 {HERE}/calculix_robot.py {out} {name}"
    if not body.exists():
        run.shell(f"cd {out}; PYTHONPATH={HERE}/../independent /usr/bin/python3 -c"
                  f" 'import make, pathlib; make.write_bodies(pathlib.Path())'; hs-tetmesh -q {name}.stl -o {body}")
    if not (work / "unseen.csv").exists():
        (work / "motion.csv").write_text(calculix_unseen(name))
        run.shell(f"SEED=5 {robot} {work}/motion.csv >{work}/unseen.part && mv {work}/unseen.part {work}/unseen.csv")
    return body, robot, None


def main():
    binaries, out = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    out = out.resolve()
    os.environ.setdefault("RIM", "0.15")
    os.environ.update(PATH=f"{binaries}:{os.environ['PATH']}", NOISE=str(NOISE), SEED="11")
    print("%-16s %7s  %-34s %6s %6s %9s  %7s  %s"
          % ("body", "presses", "hs-plan says", "error", "worst", "in band", "of grid", "its presses"))
    good = within = places = 0
    wanted = sys.argv[3:] or list(BODIES) + ["regions-" + body for body in CALCULIX]
    for name in wanted:
        work = out / name
        if name in BODIES:
            body, robot, grid = own_body(out, work, name)
        else:
            body, robot, grid = calculix_body(out, work, name.removeprefix("regions-"))
        answer = loop(work, body, robot)
        error, worst, inside, count, band = foretold(work, "after-loop", work / "loop/data.csv", body)
        of_grid = "%7s" % "-"
        if grid:
            side = max(2, round(math.sqrt(answer["presses"])))
            grid(side)
            of_grid = "%7.2f  %d" % (foretold(work, f"after-grid-{side}", work / f"grid-{side}.csv", body)[0], side * side)
        told = [g for g in answer["goals"] if g["goal"] == "unseen"][0]["value"]
        says = "%s, %s: %s" % ("reached" if answer["reached"] else "ended", "+".join(answer["missing"]) or answer["verdict"],
                               "-" if told is None else "%.1f" % told)
        good += answer["reached"] and error <= float(RATIO)
        within += inside
        places += count
        print("%-16s %7d  %-34s %6.2f %6.1f %3d of %2d  %s"
              % (name, answer["presses"], says, error, worst, inside, count, of_grid), flush=True)
    print(f"\nat most {RATIO} times the noise at unseen places in {good} of {len(wanted)};"
          f" within the stated band {within} of {places} places")


if __name__ == "__main__":
    main()
