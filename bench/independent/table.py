"""table.py OUT FROM [NAME...]: what was hidden, what was named, and the error over the noise, as
identified with Young's modulus and Poisson's ratio alone and with all that is missing added.

right: what is missing is what is hidden. more: that and something else. part: some of it, no more.
ambiguous: what is hidden is in the set that is called indistinguishable, and nothing wrong is
missing. open: called unexplained, nothing wrong named. wrong: the rest."""
import csv
import json
import pathlib
import sys


def judge(hidden, missing, alike, verdict):
    if not hidden:
        return "right" if verdict == "complete" and not missing else "wrong"
    if missing == hidden and verdict != "ambiguous":
        return "right"
    if hidden < missing:
        return "more"
    if missing <= hidden and hidden <= missing | alike:
        return "ambiguous"
    if not missing <= hidden or alike and not alike & hidden:
        return "wrong"
    return "part" if missing or alike & hidden else "open" if verdict == "unexplained" else "wrong"


def row(out, source, name, hidden):
    folder = out / "diagnosed" / source
    if not (folder / (name + ".json")).exists():
        return None
    found = json.loads((folder / (name + ".json")).read_text())
    missing = [e["effect"] for e in found["effects"] if e["verdict"] == "missing"]
    alike = [e["effect"] for e in found["effects"] if e["verdict"] == "indistinguishable"]
    judged = judge(set(hidden), set(missing), set(alike), found["verdict"])
    named = " ".join(missing) + (" (" + " | ".join(alike) + ")" if alike else "")
    noise = found["force_noise"]
    seconds = (folder / (name + ".seconds")).read_text().strip()
    return (name, " ".join(hidden) or "nothing", named.strip() or "-", found["verdict"], found["rmse"] / noise,
            found["rmse_with_missing_effects"] / noise, found["heldout_with_missing_effects"] / noise, judged, int(seconds))


if __name__ == "__main__":
    out, source, wanted = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3:]
    counts = {}
    if not wanted:
        print("%-20s %-30s %-40s %-11s %6s %6s %6s  %-9s %4s" % (
            "recording", "hidden", "named (alike)", "verdict", "before", "after", "unseen", "judged", "s"))
    for truth in csv.DictReader((out / "truth.csv").open()):
        hidden = [] if truth["hidden"] == "nothing" else truth["hidden"].split()
        line = None if wanted and truth["name"] not in wanted else row(out, source, truth["name"], hidden)
        if line:
            print("%-20s %-30s %-40s %-11s %6.2f %6.2f %6.2f  %-9s %4d" % line)
            counts[line[7]] = counts.get(line[7], 0) + 1
    if not wanted:
        print("; ".join("%s %d" % c for c in sorted(counts.items())))
