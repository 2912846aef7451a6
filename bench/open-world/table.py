"""table.py OUT [RECORDING...]: hidden cause, verdict, what was named, kind that was said to be left, errors over the
noise (of the elastic model, and with all that is named).

named: what is missing is the cause, and nothing else. set: a set of at most three that are told to look alike, with
the cause in it, nothing wrong beside it; wide: such a set of more. kind: its kind is said. open: called unexplained
without a kind, or with another. hedged: something wrong is named, but the words say that more is left, or that the
set-up would do the same. unseen: called complete, and the elastic model leaves no more than noise (1.1 times). wrong:
the rest. right: a null called complete."""
import csv
import json
import pathlib
import sys


# Of hs-compare's words: an offset, pressed or not, is the sensor's zero; what goes with the session is time.
KINDS = {"offset": "set-up", "drift": "time", "session-time": "time"}


def judge(names, kind, missing, alike, verdict, said, hint, error):
    if verdict == "complete":
        return "right" if not kind else "unseen" if error < 1.1 else "wrong"
    if not kind:
        return "wrong"
    good = set(names)
    clean = set(missing) <= good
    if good & set(missing) and clean and verdict == "incomplete" and not said:
        return "named"
    if good & set(alike) and clean:
        return "set" if len(alike) <= 3 else "wide"
    if clean and not alike:
        return "kind" if KINDS.get(said, said) == kind else "open"
    return "hedged" if said or hint else "wrong"


def row(out, name, truth):
    found = json.loads((out / "diagnosed" / (name + ".json")).read_text())
    missing = [e["effect"] for e in found["effects"] if e["verdict"] == "missing"]
    alike = [e["effect"] for e in found["effects"] if e["verdict"] == "indistinguishable"]
    said = found.get("left", {}).get("kind", "")
    named = " ".join(missing) + (" (" + " | ".join(alike) + ")" if alike else "")
    return (name, found["verdict"], named.strip() or "-", said or "-", found["rmse"] / found["force_noise"],
            found["rmse_with_missing_effects"] / found["force_noise"],
            judge(truth["names"].split(), truth["kind"], missing, alike, found["verdict"], said,
                  "before the body" in found["explanation"],
                  found["rmse"] / found["force_noise"]))


if __name__ == "__main__":
    out, wanted = pathlib.Path(sys.argv[1]), sys.argv[2:]
    truths = {t["cause"]: t for t in csv.DictReader((out / "truth.csv").open())}
    print("%-20s %-11s %-52s %-7s %6s %6s  %s" % ("recording", "verdict", "named (alike)", "left", "before", "after", "judged"))
    counts = {}
    for file in sorted((out / "diagnosed").glob("*.json")):
        truth = truths.get(file.stem.split("-", 1)[1])
        if truth is None or wanted and file.stem not in wanted:
            continue
        line = row(out, file.stem, truth)
        print("%-20s %-11s %-52s %-7s %6.2f %6.2f  %s" % line)
        counts[line[-1]] = counts.get(line[-1], 0) + 1
    print("; ".join("%s %d" % c for c in sorted(counts.items())))
