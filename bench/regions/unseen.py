"""unseen.py BIN OUT DATA.csv=BODY.ply...: whether what a model says of places that it has not seen holds.

Every fourth place of a recording is left out, in four ways; hs-identify --add regions sees the others and states
a band (metadata unseen_band, of the force's root mean square at a place, and its chance). A left-out place lies
within where the error of the model's forces there, the noise taken out, is at most that share of the force.
Prints each place, then how many lie within beside what was promised. OUT keeps the models, which are not made
again. Recordings: those of run.sh and of bench/independent/run.sh (regions-cuboid, -ball, -organ).
Recorded in bench/results/regions-unseen.txt (bench/record.sh)."""
import math
import os
import subprocess
import sys

WAYS = 4


def read(path):
    header, columns, rows = [], None, []
    with open(path) as file:
        for line in file:
            if line.startswith("#"):
                header.append(line)
            elif columns is None:
                columns = line.strip().split(",")
            elif line.strip():
                rows.append(line.strip().split(","))
    return header, columns, rows


def write(path, header, columns, rows):
    with open(path, "w") as file:
        file.writelines(header)
        for row in [columns] + rows:
            file.write(",".join(row) + "\n")


def metadata(path):
    with open(path) as file:
        return dict(line[1:].strip().split(": ", 1) for line in file if line.startswith("#") and ": " in line)


def main():
    binaries, out = sys.argv[1:3]
    os.makedirs(out, exist_ok=True)
    within = all_places = 0
    promised = 0.0
    print("%-16s %4s %7s %7s %9s %9s" % ("recording", "way", "band", "chance", "place", "error"))
    for pair in sys.argv[3:]:
        data, body = pair.split("=")
        name = os.path.basename(data)[:-4]
        header, columns, rows = read(data)
        at = [columns.index(c) for c in ("x", "y", "z")]
        place = [tuple(row[k] for k in at) for row in rows]
        places = sorted(set(place))
        force = [columns.index(c) for c in ("fx", "fy", "fz")]
        for way in range(WAYS):
            left_out = set(places[way::WAYS])
            known, unseen, model, simulated = ("%s/%s-%d%s.csv" % (out, name, way, what) for what in ("", "-unseen", "-model", "-forces"))
            if not os.path.exists(model):
                write(known, header, columns, [r for r, p in zip(rows, place) if p not in left_out])
                write(unseen, header, columns, [r for r, p in zip(rows, place) if p in left_out])
                subprocess.run([binaries + "/hs-identify", "-q", known, "--body", body, "--add", "regions", "-o", model], check=True)
                subprocess.run([binaries + "/hs-simulate", "-q", unseen, "--body", body, "--model", model, "-o", simulated], check=True)
            said = metadata(model)
            if "unseen_band" not in said:
                print("%-16s %4d  states no band" % (name, way), flush=True)
                continue
            band, chance, noise = (float(said[k]) for k in ("unseen_band", "unseen_chance", "force_noise"))
            _, simulated_columns, simulated_rows = read(simulated)
            their = [simulated_columns.index(c) for c in ("fx", "fy", "fz")]
            _, _, measured_rows = read(unseen)
            for p in sorted(left_out):
                error = size = count = 0
                for m, s in zip(measured_rows, simulated_rows):
                    if tuple(m[k] for k in at) != p:
                        continue
                    for i, j in zip(force, their):
                        error += (float(m[i]) - float(s[j])) ** 2
                        size += float(m[i]) ** 2
                        count += 1
                off = math.sqrt(max(0, error - count * noise ** 2) / (size - count * noise ** 2))
                all_places += 1
                within += off <= band
                promised += chance
                print("%-16s %4d %6.1f%% %6.0f%% %9d %8.1f%% %s" % (
                    name, way, 100 * band, 100 * chance, places.index(p), 100 * off, "" if off <= band else "outside"), flush=True)
    if all_places:
        spread = 1.96 * math.sqrt(promised * (1 - promised / all_places))
        print("\nwithin the stated band: %d of %d = %.1f %%; promised %.1f (%.1f to %.1f)" % (
            within, all_places, 100 * within / all_places, promised, promised - spread, min(all_places, promised + spread)))


if __name__ == "__main__":
    main()
