"""The tutorial on hidden effects; usage: tutorial.py SECTION..., in a folder with body.ply and a.csv to e.csv."""

import sys

import hapsim


def say(words):
    print(words, file=sys.stderr)


def identify(recording, name, **options):
    model = hapsim.identify(recording, BODY, say=say, **options)
    model.write(name + ".csv")
    say(model.summary["verdict"])
    return model


def simulate_and_compare(recording, model, name, forces=None):
    simulated = hapsim.simulate(recording, BODY, model, say=say)
    if forces:
        simulated.write(forces)
    comparison = hapsim.compare(recording, simulated)
    comparison.residuals.write(name + "-residuals.csv")
    say(f"{name}: error {comparison['rmse']:.3g} N, noise {comparison['noise']:.3g} N")
    for observation in comparison["observations"]:
        say("  " + observation["sentence"])
    return simulated


def diagnose(recording, model, name):
    diagnosis = hapsim.diagnose(recording, BODY, model, output=name + "-effects.csv", say=say)
    diagnosis.write(name + "-effects.csv")
    found = [f["effect"] for f in diagnosis["effects"] if f["verdict"] == "missing"]
    say(f"{name}: {diagnosis['verdict']} {' '.join(found)}".rstrip())
    return diagnosis


def a(data):
    """One effect: the stiffness differs from place to place."""
    a0 = identify(data, "a0", effects="elastic")
    simulate_and_compare(data, a0, "a0", forces="a0-forces.csv")
    diagnose(data, a0, "a0")
    a1 = identify(data, "a1", model=a0, add="regions")
    diagnose(data, a1, "a1")


def b(data):
    """Right along the normal, far too stiff sideways."""
    b0 = identify(data, "b0", effects="elastic")
    simulate_and_compare(data, b0, "b0")
    diagnose(data, b0, "b0")
    identify(data, "b1", model=b0, add="friction")


def c(data):
    """Two effects, one call."""
    c1 = identify(data, "c1", effects="auto")
    c0 = identify(data, "c0", effects="elastic")
    hapsim.simulate(data, BODY, c0).write("c0-forces.csv")
    simulate_and_compare(data, c1, "c", forces="c1-forces.csv")


def d(data):
    """Nothing."""
    d0 = identify(data, "d0", effects="elastic")
    diagnose(data, d0, "d0")


def e(data):
    """Something that no effect explains."""
    e0 = identify(data, "e0", effects="elastic")
    simulate_and_compare(data, e0, "e0")
    diagnose(data, e0, "e0")


if __name__ == "__main__":
    BODY = hapsim.Body.read("body.ply")
    for section in sys.argv[1:] or "abcde":
        globals()[section](hapsim.Recording.read(section + ".csv"))
