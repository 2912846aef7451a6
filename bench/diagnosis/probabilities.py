"""probabilities.py STATEMENTS.csv...: whether the probabilities that diagnoses state are what they say.

A statement is an effect and the probability that it acts; it is true where it is hidden, or one of those
that the truth is made of. Files are the statements.csv that bench_diagnosis leaves beside its trials. By
tenths: statements, their mean probability, the share that is true, the band in which that lies in 95 of
100 were they right (binomial), and whether it does; then the log loss beside that of the base rates (the
share of true ones by effect)."""
import collections
import csv
import math
import sys

COLUMNS = "truth level seed effect verdict true probability share_among gain memory noise_alone".split()


def statements(files):
    for name in files:
        with open(name) as file:
            for row in csv.reader(file):
                s = dict(zip(COLUMNS, row))
                if s["probability"] not in ("", "nan"):
                    yield s["effect"], s["verdict"], float(s["probability"]), int(s["true"])


def loss(p, true):
    p = min(max(p, 1e-6), 1 - 1e-6)
    return -math.log(p if true else 1 - p)


def within_band(p, true):
    """Of a sum of draws with those probabilities, by its normal approximation and half a count."""
    mean, sd = sum(p), math.sqrt(sum(q * (1 - q) for q in p))
    return mean - 1.96 * sd - 0.5, mean + 1.96 * sd + 0.5, abs(true - mean) <= 1.96 * sd + 0.5


def main():
    rows = list(statements(sys.argv[1:]))
    print("%-9s %10s %8s %8s %17s" % ("stated", "statements", "mean", "true", "band"))
    for tenth in range(10):
        some = [r for r in rows if tenth == min(9, int(10 * r[2]))]
        if not some:
            continue
        n, true = len(some), sum(r[3] for r in some)
        low, high, inside = within_band([r[2] for r in some], true)
        print("%.1f-%.1f   %10d %8.4f %8.4f   %.4f to %.4f  %s" % (
            tenth / 10, (tenth + 1) / 10, n, sum(r[2] for r in some) / n, true / n, max(0, low / n), min(1, high / n),
            ("inside" if inside else "OUTSIDE") + ("" if n >= 50 else " (few)")))
    rate = collections.defaultdict(list)
    for effect, _, _, true in rows:
        rate[effect].append(true)
    base = sum(loss(sum(rate[e]) / len(rate[e]), true) for e, _, _, true in rows) / len(rows)
    print("log loss %.4f a statement, of the base rates %.4f" % (sum(loss(p, t) for _, _, p, t in rows) / len(rows), base))
    by = collections.defaultdict(list)
    for _, verdict, p, true in rows:
        by[verdict].append((p, true))
    for verdict, some in sorted(by.items()):
        print("%-18s %6d, stated %.4f, true %.4f" % (verdict, len(some), sum(p for p, _ in some) / len(some), sum(t for _, t in some) / len(some)))


if __name__ == "__main__":
    main()
