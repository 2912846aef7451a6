"""coverage.py SIZES.csv...: how often intervals of 95 % hold the truth.

Files are the sizes.csv that bench_diagnosis leaves beside its trials, one a body. By group (E, nu, material,
contact, set-up; nothing hidden, one effect, pairs): sizes, the share whose interval holds the truth, the band
of that share when bodies are drawn anew (95 % of 2000 resamplings), the median half width of the interval as a
share of the truth, and the root mean square of the standardised error, 1 where standard errors are right."""
import collections
import csv
import math
import random
import statistics
import sys

COLUMNS = "truth seed group effect name value exact std_error".split()


def sizes(files):
    for name in files:
        with open(name) as file:
            for row in csv.reader(file):
                s = dict(zip(COLUMNS, row))
                value, exact, error = (float(s[c]) for c in ("value", "exact", "std_error"))
                hidden = "nothing" if s["truth"].startswith("nothing") else "pair" if "&" in s["truth"] else "one"
                if error > 0:
                    yield name, hidden, s["group"], (value - exact) / error, 1.96 * error / abs(exact) if exact else math.nan


def band(by_body, draw):
    shares = []
    bodies = list(by_body.values())
    for _ in range(2000):
        some = [z for _ in bodies for z in draw.choice(bodies)]
        shares.append(sum(abs(z) <= 1.96 for z in some) / len(some))
    shares.sort()
    return shares[50], shares[1949]


def main():
    rows = list(sizes(sys.argv[1:]))
    draw = random.Random(1)
    print("%d bodies" % len({r[0] for r in rows}))
    print("%-10s %-8s %6s %7s %16s %9s %6s" % ("of", "hidden", "sizes", "inside", "band", "half width", "rms"))
    keys = collections.defaultdict(list)
    for r in rows:
        for key in ((r[2], r[1]), (r[2], "all"), ("all", r[1]), ("all", "all")):
            keys[key].append(r)
    for (group, hidden), some in sorted(keys.items()):
        by_body = collections.defaultdict(list)
        for r in some:
            by_body[r[0]].append(r[3])
        low, high = band(by_body, draw)
        widths = [r[4] for r in some if math.isfinite(r[4])]
        print("%-10s %-8s %6d %6.1f%% %6.1f to %5.1f%% %8.1f%% %6.2f" % (
            group, hidden, len(some), 100 * sum(abs(r[3]) <= 1.96 for r in some) / len(some), 100 * low, 100 * high,
            100 * statistics.median(widths) if widths else math.nan, math.sqrt(sum(r[3] ** 2 for r in some) / len(some))))


if __name__ == "__main__":
    main()
