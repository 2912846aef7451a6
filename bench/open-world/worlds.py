"""worlds.py NULL SOLVED OUT BODY [CAUSE...]: recordings with a cause that is in the set-up, made from NULL, a recording
of a linear body that hides nothing, as OUT/data/BODY-CAUSE.csv; OUT/truth.csv says what is hidden.

The contact stiffness of each place is CalculiX's (SOLVED, the folder of bench/independent/stiffnesses.py), so no model of
hapsim's is in these data. The cause acts on what was moved or measured, then noise of the size that NULL declares is
added."""
import csv
import pathlib
import sys
import zlib

import numpy as np

import bodies
import callers
import causes
import drifters
import guests
import latecomers
import newcomers
import outsiders
import passersby
import stiffnesses
import strangers
import strays
import visitors
import wayfarers

EVERY = (causes.every_cause() + strangers.every_stranger() + newcomers.every_newcomer() +
         outsiders.every_outsider() + visitors.every_visitor() + guests.every_guest() +
         callers.every_caller() + strays.every_stray() + drifters.every_drifter() +
         latecomers.every_latecomer() + passersby.every_passerby() + wayfarers.every_wayfarer())


class Null:
    """head: comment lines; press (n); t (n) [s] in the session; x, u, f (n, 3); K (n, 3, 3) [N/m]: the forces are K u; noise [N]."""

    def __init__(self, path, solved, body):
        lines = pathlib.Path(path).read_text().splitlines()
        self.head = [line for line in lines if line.startswith("#")]
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))

        def columns(*names):
            return np.array([[float(r[n]) for n in names] for r in rows])

        self.press = columns("press")[:, 0].astype(int)
        self.t = columns("t")[:, 0]
        self.x, self.u = columns("x", "y", "z"), columns("ux", "uy", "uz")
        self.noise = next(float(h.split(":")[1]) for h in self.head if h.startswith("# force_noise:"))
        points = np.array([1e-3 * np.asarray(point) for point, _ in bodies.places(body)])
        K = stiffnesses.load(solved, body, 4.0, "plain")
        place = np.linalg.norm(self.x[:, None] - points, axis=2)
        if place.min(axis=1).max() > 1e-6:
            raise SystemExit("%s: a place that %s has no stiffness of" % (path, solved))
        self.K = -K[place.argmin(axis=1)]
        self.f = self.forces(self.u)

    def forces(self, u):
        """Of the body when it is moved by u."""
        return np.einsum("nij,nj->ni", self.K, u)


def save(path, null, head, u, f):
    """A recording of NULL's presses whose tool went by u and met f."""
    lines = list(head) + ["press,t,x,y,z,ux,uy,uz,fx,fy,fz"]
    for p, t, x, v, g in zip(null.press, null.t, null.x, u, f):
        lines.append("%d,%.2f,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.4f,%.4f,%.4f" % (p, t, *x, *v, *g))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n")


def write(null, body, cause, out):
    name = "%s-%s" % (body, cause.name)
    random = np.random.default_rng(zlib.crc32(name.encode()))
    save(out / "data" / (name + ".csv"), null, *cause.make(null, random))


if __name__ == "__main__":
    recording, solved, out, body, *wanted = sys.argv[1:]
    null, out = Null(recording, solved, body), pathlib.Path(out)
    for cause in EVERY:
        if wanted and cause.name not in wanted:
            continue
        write(null, body, cause, out)
    with (out / "truth.csv").open("w") as truth:
        truth.write("cause,kind,names,known\n")
        for cause in EVERY:
            truth.write("%s,%s,%s,%s\n" % (cause.name, cause.kind, " ".join(cause.names), " ".join(cause.known)))
