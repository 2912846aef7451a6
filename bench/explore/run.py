#!/usr/bin/env python3
"""run.py BIN OUT [BODY...]: presses of a closed loop (hs-plan with a simulated robot) against those of the smallest
regular grid that comes to the right end, on the bodies of bodies.py. A line a body on standard output.

An end is right when hs-plan calls its goal reached and the verdict is what is hidden: the very effects and E known to
3 %; of a lump the 95 % intervals of its centre within 2 mm to each side, and the centre within 2 mm of the true one.
The loop ends by what hs-plan says, which knows no truth; the grids (2 x 2 to 5 x 5 places) are tried in turn until one
is right: with the usual three presses a place (slow, fast with a hold, sideways), and with one a place in turn; for a
lump with one alone, since places are what tells. Where none is
right, the smallest that could be is the next one, and counts as such (>=).

Forces are those of the exact shape on a mesh of its own (RIM, 0.15 of the tool's radius at its rim), the body is made
of a scan; noise 0.01 N. OUT keeps everything, and what is there is not made again. GRIDS (3 1) says which presses a
place are tried; KEPT=yes tells of what is there and runs nothing. Recorded in bench/results/explore.txt
(bench/record.sh)."""

import json
import os
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
import grids  # noqa: E402
from bodies import BODIES, ELASTIC  # noqa: E402

HERE = Path(__file__).resolve().parent
SHARE = HERE.parent.parent / "share/examples"
GOALS = {False: "verdict,E=3%", True: "lump=2mm"}
SIDES = range(2, 6)
MOST = 40  # presses of a loop
# The shapes and the scan are those of bench/diagnosis/run.sh.
SHAPES = {
    "phantom": "awk -v what=dome -v a=0.055 -v b=0.042 -v c=0.038 -v n=96 -v m=32 -v lobe=0 -f {0}/shapes.awk",
    "organ": "awk -v what=dome -v a=0.05 -v b=0.045 -v c=0.035 -v n=96 -v m=32 -v lobe=0.25 -f {0}/shapes.awk",
    "block": "awk -v what=cuboid -v a=0.11 -v b=0.09 -v c=0.04 -f {0}/shapes.awk |"
    " awk 'NF == 3 && NR > 2 {{ $1 -= 0.055; $2 -= 0.045 }} {{ print }}'",
}


class NotThere(Exception):
    """What KEPT asks for was not run to its end."""


def kept():
    return os.environ.get("KEPT") == "yes"


def shell(command, **options):
    if kept():
        raise NotThere
    return subprocess.run(["bash", "-euo", "pipefail", "-c", command], check=True, **options)


def shape_of(out, shape):
    folder = out / shape
    if not (folder / "body.ply").exists() and not kept():
        folder.mkdir(parents=True, exist_ok=True)
        shell(f"""cd {folder}; {SHAPES[shape].format(SHARE)} >surface.off
          awk -v count=3000 -f {HERE}/../diagnosis/scan.awk surface.off >scan.csv
          hs-tetmesh -q surface.off -o true.ply
          hs-scan2ply -q scan.csv --unit mm | hs-reconstruct -q | hs-tetmesh -q -o body.ply""")
    return folder


def ask(data, body, lump, path, presses, most, motion="/dev/null"):
    """hs-plan's answer to a recording, as JSON; `most` 1: judged alone, without a plan."""
    if not path.exists():
        if kept():
            raise NotThere
        run = subprocess.run(
            ["hs-plan", "-q", str(data), "--body", str(body), "--tool-radius", "4mm", "--goal", GOALS[lump],
             "--presses", str(presses), "--most-presses", str(most), "--threads", "1", "--json", str(path) + ".new",
             "-o", str(motion)], stderr=subprocess.PIPE, text=True)
        if run.returncode != 0:  # a recording that bears no judgement, as an image of too few places
            Path(str(path) + ".new").write_text(json.dumps(
                {"reached": False, "ended": True, "failed": run.stderr.strip(), "verdict": "failed", "missing": [],
                 "presses": 0, "goals": [], "lumps": [], "next": [], "aim": "none"}))
        os.replace(str(path) + ".new", path)
    return json.loads(path.read_text())


def right(answer, hidden):
    if not answer["reached"]:
        return False
    if isinstance(hidden, tuple):
        return sum((a - b) ** 2 for a, b in zip(answer["lumps"][0]["centre"], hidden)) ** 0.5 <= 0.002
    return sorted(answer["missing"]) == sorted(hidden)


def said(answer):
    if answer["lumps"] and answer["verdict"] is None:
        return "lump (%.1f %.1f %.1f) mm" % tuple(1e3 * x for x in answer["lumps"][0]["centre"])
    if answer["verdict"] is None:
        return "no lump seen" if answer["goals"] else "too few presses to settle anything"
    names = "+".join(answer["missing"])
    return answer["verdict"] + (": " + names if names else "")


def by_loop(work, body, lump):
    """Batches of six, then of two."""
    folder = work / "loop"
    data, k = folder / "data.csv", 0
    if not kept():
        folder.mkdir(exist_ok=True)
        data.touch()
    for k in range(MOST):
        motion = folder / f"motion-{k}.csv"
        answer = ask(data, body, lump, folder / f"plan-{k}.json", 6 if k == 0 else 2, MOST, motion)
        if answer["reached"] or answer["ended"]:
            return answer
        if not (folder / f"done-{k}").exists():
            shell(f"{SHARE}/explore/robot.sh {work}/truth {motion} >{folder}/new.csv && cat {folder}/new.csv >>{data}"
                  f" && touch {folder}/done-{k}")
    return answer


def by_grid(work, shape_folder, shape, body, lump, hidden, kinds):
    """The first right answer, or the last one; and the presses of the smallest grid that is, or could be, right."""
    surface = grids.read_off(shape_folder / "surface.off")
    last = None
    for side in SIDES:
        presses = kinds * side * side
        folder = work / f"grid-{kinds}-{side}"
        try:
            if not kept():
                folder.mkdir(exist_ok=True)
            if not kept() and not (folder / "data.csv").exists():
                (folder / "motion.csv").write_text(grids.motion(surface, shape, side, kinds))
                shell(f"hs-simulate -q {folder}/motion.csv --body {work}/truth/body.ply --model {work}/truth/model.csv"
                      f" --rim-edge $RIM --add-noise 0.01 --seed 12 -o {folder}/data.csv")
            answer = ask(folder / "data.csv", body, lump, folder / "plan.json", 1, 1)
        except NotThere:
            if last is None:
                raise
            return last, presses
        if right(answer, hidden):
            return answer, presses
        last = answer
    return last, kinds * SIDES.stop**2


def both(*asked, hidden, kinds):
    """What the grids with so many presses a place come to."""
    ends = {}
    for k in kinds:
        try:
            ends[k] = by_grid(*asked, hidden, k)
        except NotThere:
            pass
    if not ends:
        raise NotThere
    return ends


def main():
    binaries, out = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    out = out.resolve()
    wanted = sys.argv[3:]
    kinds = [int(k) for k in os.environ.get("GRIDS", "3 1").split()]
    os.environ.setdefault("RIM", "0.15")
    os.environ.update(PATH=f"{binaries}:{os.environ['PATH']}", NOISE="0.01", SEED="11")
    line = "%-24s %4s  %-44s %6s %6s %6s %6s  %s"
    print(line % ("hidden", "loop", "says", "3 each", "ratio", "1 each", "ratio", "the last grid says"))
    good = tried = 0
    asked, halves = {1: 0, 3: 0}, {1: 0, 3: 0}  # by presses a place
    table = {body[0]: body for body in BODIES}
    for name, shape, rows, hidden in [table[w] for w in wanted] if wanted else BODIES:
        lump = isinstance(hidden, tuple)
        shape_folder, work = shape_of(out, shape), out / name
        if not kept():
            (work / "truth").mkdir(parents=True, exist_ok=True)
        if not kept() and not (work / "truth/model.csv").exists():
            shell(f"cp {shape_folder}/true.ply {work}/truth/body.ply")
            (work / "truth/model.csv").write_text("effect,region,parameter,value\n" + ELASTIC + rows)
        body = shape_folder / "body.ply"
        try:
            loop = by_loop(work, body, lump)
            ends = both(work, shape_folder, shape, body, lump, hidden=hidden, kinds=(1,) if lump and not kept() else kinds)
        except NotThere:
            continue
        presses = {k: smallest for k, (a, smallest) in ends.items()}
        least = {k: "" if right(a, hidden) else ">=" for k, (a, smallest) in ends.items()}
        ok = right(loop, hidden)
        tried += 1
        good += ok
        for k in ends:
            asked[k] += 1
            halves[k] += ok and loop["presses"] <= presses[k] / 2
        grid = {k: f"{least[k]}{presses[k]}" for k in ends}
        ratio = {k: ("<=" if least[k] else "") + "%.2f" % (loop["presses"] / presses[k]) if ok else "-" for k in ends}
        end = ("right, " if ok else "WRONG, " if loop["reached"] else "open, ") + said(loop)
        print(line % (name, loop["presses"], end, *(x.get(k, "-") for k in (3, 1) for x in (grid, ratio)),
                      said(ends[min(ends)][0])), flush=True)
    print(f"\nloop right in {good} of {tried}; right with at most half the presses of the smallest right grid:"
          f" {halves[3]} of {asked[3]} with three presses a place, {halves[1]} of"
          f" {asked[1]} with one")


if __name__ == "__main__":
    main()
