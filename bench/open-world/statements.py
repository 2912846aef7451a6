"""statements.py OUT...: what the diagnoses of worlds say of each effect, as bench/diagnosis/probabilities.py reads it.

An effect acts where it is the cause, another name of it, or acts beside it. Where a name of the cause is said to be
missing or in a set, of its other names nothing is counted; nor of curves without a law, nor of nulls' sets."""
import csv
import json
import pathlib
import sys

SURE = "missing indistinguishable".split()


def statements(out):
    truths = {t["cause"]: t for t in csv.DictReader((out / "truth.csv").open())}
    for file in sorted((out / "diagnosed").glob("*.json")):
        truth = truths.get(file.stem.split("-", 1)[1])
        if truth is None:
            continue
        found = json.loads(file.read_text())
        names = set(truth["names"].split())
        told = any(e["effect"] in names and e["verdict"] in SURE for e in found["effects"])
        for e in found["effects"]:
            acts = e["effect"] in names | set(truth["known"].split())
            other_name = told and e["effect"] in names and e["verdict"] not in SURE
            if e.get("probability") is None or e["effect"].startswith("learned-") or other_name:
                continue
            yield (file.stem, 0, 0, e["effect"], e["verdict"], int(acts), e["probability"], "", "", "", "")


if __name__ == "__main__":
    rows = csv.writer(sys.stdout)
    for folder in sys.argv[1:]:
        rows.writerows(statements(pathlib.Path(folder)))
