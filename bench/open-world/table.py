"""table.py OUT [RECORDING...]: hidden cause, verdict, what was named, kind that was said to be left, errors over the
noise (of the elastic model, and with all that is named).

named: what is missing is the cause, and nothing else; what acts beside it may be told by the curve that contains it.
set: a set of at most three that are told to look alike, with the cause in it, nothing wrong beside it; wide: such a set
of more. kind: its kind is said, by what is left or by a curve of no law; alike: so is another, of three at most that
presses do not tell apart. kin: other effects are named, each of which is first of all of the cause's kind
(EffectCard::kinds). open: called unexplained without a kind, or with another, or what acts beside it is named and more
is said to be left. hedged: something wrong is named, but the words say that more is left, or that the set-up would do
the same; told: so, and the kind of all that the model misses is said. companion: the cause, and a wrong name beside it,
nothing left. unseen: called complete, and the elastic model leaves no more than noise (1.1 times), or what acts beside
it is named and leaves no more. wrong: the rest. right: a null called complete; where noise itself is the cause, no
name."""
import csv
import json
import pathlib
import sys


# Of hs-compare's words and of curves without a law: what each says of a cause. An offset, pressed or not, is the
# sensor's zero; what goes with the session is time.
SAID = {"offset": "set-up offset", "drift": "time session offset", "session-time": "time session", "contact-time": "history", "history": "history", "reading": "depth axes",
        "phase": "history", "cycle": "order", "rate": "speed", "position": "place", "body": "place", "place": "place",
        "press-direction": "direction", "set-up": "set-up axes", "direction": "direction axes", "learned-depth": "depth",
        "learned-kernel": "time history", "learned-drift": "time session offset", "learned-gain": "time session",
        "learned-place": "place", "learned-axes": "direction axes", "press": "session order",
        "place-and-way": "place direction", "wander": "frequency session", "zero-of-press": "session order offset"}
# What acts beside a cause, and the curve that contains it (the effects' cards).
CONTAINED = {"viscoelastic": "learned-kernel", "sensor-bias": "learned-drift"}
MOST_ALIKE = 3


def judge(names, kind, missing, alike, verdict, said, hint, error, known=(), end=0.0, first=None, others=(), one_kind=None,
          misfit=""):
    """first: of each effect the first of its kinds; others: kinds that what is left may have as well;
    one_kind: of two names and more."""
    kinds = set(kind.split())
    if "noise" in kinds:
        return "right" if not missing and not alike else "hedged" if said or hint else "wrong"
    if verdict == "complete":
        return "right" if not kind else "unseen" if error < 1.1 else "wrong"
    if not kind:
        return "wrong"

    def tells(word):
        return word in kinds or kinds & set(SAID.get(word, "").split())

    good = set(names) | set(n for n in missing + alike if n.startswith("learned-") and tells(n))
    beside = set(known) | set(CONTAINED[n] for n in known if n in CONTAINED)
    clean = set(missing) <= good | beside
    if good & set(missing) and clean and verdict == "incomplete" and not said:
        return "named" if set(names) & set(missing) - set(SAID) else "kind"
    if good & set(alike) and clean:
        return "set" if len(alike) <= 3 else "wide"
    if clean and not set(alike) - beside:
        if not said and known and verdict == "incomplete":
            return "unseen" if end < 1.1 else "wrong"
        if said and tells(said) or good & set(missing):
            return "kind"
        return "alike" if len(others) < MOST_ALIKE and any(tells(other) for other in others) else "open"
    if one_kind and tells(one_kind):  # several names of one kind stand for it
        return "kind"
    if all(name in good | beside or tells((first or {}).get(name, "")) for name in missing + alike):
        return "kin"
    if said or hint:
        return "told" if misfit and tells(misfit) else "hedged"
    return "companion" if good & set(missing) or (known and set(known) <= set(missing)) else "wrong"


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
                  found["rmse"] / found["force_noise"], truth["known"].split(),
                  found["rmse_with_missing_effects"] / found["force_noise"],
                  {e["effect"]: e["kinds"][0] for e in found["effects"] if e.get("kinds")},
                  [k["kind"] for k in found.get("left", {}).get("kinds", [])[1:] if k.get("alike")], found.get("one_kind"),
                  next((k["kind"] for k in found.get("misfit", [])), "")))


if __name__ == "__main__":
    out, wanted = pathlib.Path(sys.argv[1]), sys.argv[2:]
    truths = {t["cause"]: t for t in csv.DictReader((out / "truth.csv").open())}
    print("%-20s %-11s %-52s %-12s %6s %6s  %s" % ("recording", "verdict", "named (alike)", "left", "before", "after", "judged"))
    counts = {}
    for file in sorted((out / "diagnosed").glob("*.json")):
        truth = truths.get(file.stem.split("-", 1)[1])
        if truth is None or wanted and file.stem not in wanted:
            continue
        line = row(out, file.stem, truth)
        print("%-20s %-11s %-52s %-12s %6.2f %6.2f  %s" % line)
        counts[line[-1]] = counts.get(line[-1], 0) + 1
    print("; ".join("%s %d" % c for c in sorted(counts.items())))
