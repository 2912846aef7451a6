"""thin.py RECORDING: the recording without four of its places and every second sample, to standard output: a third of
the time that its diagnosis takes."""
import sys

lines = open(sys.argv[1]).read().splitlines()
head = [line for line in lines if line.startswith("#")]
header, *rows = [line for line in lines if not line.startswith("#")]
places = list(dict.fromkeys(tuple(row.split(",")[2:5]) for row in rows))
dropped = {p for k, p in enumerate(places) if k in (1, 3, 6, 8)}
print("\n".join(head + [header]))
press, count = None, 0
for row in rows:
    cells = row.split(",")
    if tuple(cells[2:5]) in dropped:
        continue
    if cells[0] != press:
        press, count = cells[0], 0
    if count % 2 == 0:
        print(row)
    count += 1
