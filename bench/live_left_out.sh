#!/usr/bin/env bash
# live_left_out.sh BIN: what hs-simulate --live says of its error between contacts, against what it is at 20 other
# places on a box's top, where the batch mode has a contact mesh each. Nine contacts, a flat tool of 4 mm, presses
# of 1 mm; Poisson's ratios 0.30, 0.45 and 0.49. Rows: what is said; what is found with the contacts and without any,
# root mean square and worst. Recorded in bench/results/live-left-out.txt (bench/record.sh).
set -euo pipefail
bin=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
awk 'BEGIN { print "OFF\n8 12 0"
  for (i = 0; i < 8; ++i) print 0.06 * (i % 2), 0.05 * (int(i / 2) % 2), 0.04 * int(i / 4)
  n = split("0 2 3,0 3 1,4 5 7,4 7 6,0 1 5,0 5 4,2 6 7,2 7 3,0 4 6,0 6 2,1 3 7,1 7 5", t, ",")
  for (i = 1; i <= n; ++i) print 3, t[i] }' >box.off
"$bin/hs-tetmesh" box.off --edge 0.015 -q -o body.ply
presses() { # SEED COUNT
  awk -v seed="$1" -v count="$2" 'BEGIN { srand(seed)
    print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
    for (p = 1; p <= count; ++p) {
      x = 0.006 + 0.048 * rand(); y = 0.006 + 0.038 * rand()
      for (i = 0; i < 2; ++i) printf "%d,%g,%.5f,%.5f,0.04,0,0,%g\n", p, i, x, y, -0.001 * i } }'
}
deepest() { grep '^[0-9]*,1,' "$1" | cut -d, -f11; } # FORCES
found() { # FORCES: against the batch mode's
  paste -d, <(deepest "$1") <(deepest batch.csv) |
    awk -F, '{ e = $1 / $2 - 1; s += e * e; if (e < 0) e = -e; if (e > worst) worst = e; ++n }
      END { printf "%d places: %.1f %% rms, %.1f %% at worst\n", n, 100 * sqrt(s / n), 100 * worst }'
}
presses 1 9 >contacts.csv
presses 2 20 >motion.csv
for nu in 0.30 0.45 0.49; do
  printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,%s,1\n' $nu >model.csv
  given=(--body body.ply --model model.csv)
  "$bin/hs-simulate" motion.csv "${given[@]}" -q -o batch.csv
  "$bin/hs-simulate" --live motion.csv "${given[@]}" --contacts contacts.csv -o with.csv 2>said
  "$bin/hs-simulate" --live motion.csv "${given[@]}" -q -o without.csv
  printf 'nu %s said: %s\n' $nu "$(sed -n 's/^hs-simulate: each of/each of/p' said)"
  printf 'nu %s found with the contacts, %s\n' $nu "$(found with.csv)"
  printf 'nu %s found without, %s\n' $nu "$(found without.csv)"
done
