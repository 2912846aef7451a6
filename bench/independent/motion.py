"""Presses as a robot records them: depths, speeds, straight and sideways, a hold each, no way out."""
import numpy as np

STEP = 0.02  # [s]
DEPTHS = np.array([1.0, 2.0, 3.0, 4.5, 6.0])  # [mm]
RAMPS = np.array([0.2, 0.4, 1.0])  # [s]


class Press:
    """place: its index; t (n) [s] in the session; u (n, 3) [m]; n: outward normal; repeat: earlier
    presses of the place; deepest: of them [m]."""

    def __init__(self, place, normal, start, target, ramp, hold):
        local = np.arange(int(round((ramp + hold) / STEP)) + 1) * STEP
        self.place, self.n = place, normal
        self.t = start + local
        self.u = np.minimum(1, local / ramp)[:, None] * target
        self.depth = -float(target @ normal)
        self.repeat, self.deepest = 0, 0.0


def sideways(normal, random):
    a = np.cross(normal, random.normal(size=3))
    return a / np.linalg.norm(a)


def session(places, seed, holds=(2.0, 3.0), straight=30, aslant=12):
    """A shuffled session of presses at (point, normal) places [mm]."""
    random = np.random.default_rng(seed)
    wanted = []
    for k in range(straight):
        wanted.append((k % len(places), random.choice(DEPTHS[2:] if k < len(places) else DEPTHS), 0.0))
    for k in random.permutation(len(places))[:aslant]:
        wanted.append((k, random.choice(DEPTHS[1:4]), random.uniform(0.6, 0.9)))
    presses, start, past = [], 0.0, {}
    for k in random.permutation(len(wanted)):
        place, depth, aside = wanted[k]
        n = places[place][1]
        target = 1e-3 * depth * (aside * sideways(n, random) - n)
        ramp = random.choice(RAMPS)
        press = Press(place, n, start, target, ramp, np.round(random.uniform(*holds) / STEP) * STEP)
        press.repeat, press.deepest = past.get(place, (0, 0.0))
        past[place] = (press.repeat + 1, max(press.deepest, press.depth))
        presses.append(press)
        start = np.round(press.t[-1] + random.uniform(20, 50), 2)
    return presses
