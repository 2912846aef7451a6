"""worlds.py NULL OUT BODY [CAUSE...]: recordings with a cause that is in the set-up, made from NULL, a recording of a
linear body that hides nothing, as OUT/data/BODY-CAUSE.csv; OUT/truth.csv says what is hidden.

The contact stiffness of each place is that which NULL itself has (least squares of its forces over its motion, whose
error is some 0.1 %), so no model of hapsim's is in these data. The cause acts on what was moved or measured, then
noise of the size that NULL declares is added."""
import csv
import pathlib
import sys
import zlib

import numpy as np

import causes
import newcomers
import strangers

EVERY = causes.every_cause() + strangers.every_stranger() + newcomers.every_newcomer()


class Null:
    """head: comment lines; press (n); t (n) [s] in the session; x, u, f (n, 3); K (n, 3, 3) [N/m], of other motions; noise [N]."""

    def __init__(self, path):
        lines = pathlib.Path(path).read_text().splitlines()
        self.head = [line for line in lines if line.startswith("#")]
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))

        def columns(*names):
            return np.array([[float(r[n]) for n in names] for r in rows])

        self.press = columns("press")[:, 0].astype(int)
        self.t = columns("t")[:, 0]
        self.x, self.u, f = columns("x", "y", "z"), columns("ux", "uy", "uz"), columns("fx", "fy", "fz")
        self.noise = next(float(h.split(":")[1]) for h in self.head if h.startswith("# force_noise:"))
        self.f, self.K = np.zeros_like(f), np.zeros((len(f), 3, 3))
        for place in np.unique(self.x, axis=0):
            here = (self.x == place).all(axis=1)
            self.f[here] = self.u[here] @ np.linalg.lstsq(self.u[here], f[here], rcond=1e-6)[0]
            # Where nothing but rounding moves the tool, forces do not tell what it would do.
            self.K[here] = np.linalg.lstsq(self.u[here], f[here], rcond=1e-3)[0].T

    def forces(self, u):
        """Of the body when it is moved by u, along directions in which the place was pressed."""
        return np.einsum("nij,nj->ni", self.K, u)


def write(null, body, cause, out):
    name = "%s-%s" % (body, cause.name)
    random = np.random.default_rng(zlib.crc32(name.encode()))
    head, u, f = cause.make(null, random)
    lines = list(head) + ["press,t,x,y,z,ux,uy,uz,fx,fy,fz"]
    for p, t, x, v, g in zip(null.press, null.t, null.x, u, f):
        lines.append("%d,%.2f,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.4f,%.4f,%.4f" % (p, t, *x, *v, *g))
    (out / "data").mkdir(parents=True, exist_ok=True)
    (out / "data" / (name + ".csv")).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    null, out, body, wanted = Null(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3], sys.argv[4:]
    for cause in EVERY:
        if wanted and cause.name not in wanted:
            continue
        write(null, body, cause, out)
    with (out / "truth.csv").open("w") as truth:
        truth.write("cause,kind,names,known\n")
        for cause in EVERY:
            truth.write("%s,%s,%s,%s\n" % (cause.name, cause.kind, " ".join(cause.names), " ".join(cause.known)))
