#!/usr/bin/env bash
# slip.sh BIN OUT: a tool that slips (friction 0.4) at finite strain, hs-simulate --live --large-strain against --full,
# whose elements slip (of a quarter of a radius at the rim). A block 80 x 60 x 30 mm that stiffens (s = 0.2), a tool of
# 4 mm at places that were not pressed beforehand, up to 0.65 radii deep, where --full ends: straight in and out; drawn
# aside with the depth and out; in, aside as far as it slips, back across and over; in askew, aside another way, and
# out. Of every motion, over its rows: the error of the force over it (floor 5 % of the largest), how many of the rows
# 1.96 times the stated uncertainty covers, and the same error of the law of a held tool. Places stay in OUT/cache.
# Recorded in bench/results/large-strain.txt (bench/record.sh).
set -euo pipefail
(($# == 2)) || { echo 'usage: slip.sh BIN OUT' >&2; exit 2; }
bin=$(cd "$1" && pwd)
mkdir -p "$2" && cd "$2"
export XDG_CACHE_HOME=$PWD/cache
awk 'BEGIN { X = 0.08; Y = 0.06; Z = 0.03; print "OFF\n8 12 0"
  for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++) print i * X, j * Y, k * Z
  print "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 3 7 5" }' >block.off
"$bin/hs-tetmesh" -q block.off --edge 0.0042 -o block.ply
printf '%s\n' effect,region,parameter,value,unit,std_error,lower,upper,state elastic,0,E,20000,Pa,,1,1e12,fixed \
  elastic,0,nu,0.4,1,,0,0.499,fixed hyperelastic,0,s,0.2,1,,0,1.2,fixed hyperelastic,0,finite,1,1,,0,1,fixed >held.csv
{ cat held.csv; echo friction,0,mu,0.4,1,,0.001,1000,fixed; } >slips.csv
printf '# tool_radius: 0.004\npress,x,y,z,ux,uy,uz\n0,0.04,0.034,0.03,0,0,0\n' >contacts.csv
for motion in straight drawn aside askew; do
  awk -v motion=$motion 'BEGIN {
    at = motion == "askew" ? "0.0321,0.0287,0.03" : "0.04,0.034,0.03"; n = 0
    print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
    row(0, 0, 0)
    if (motion == "straight") { for (i = 1; i <= 6; ++i) row(0.1 * i, 0, 0); for (i = 5; i >= 1; --i) row(0.1 * i, 0, 0) }
    if (motion == "drawn") { for (i = 1; i <= 6; ++i) row(0.1 * i, 0.067 * i, 0); for (i = 5; i >= 1; --i) row(0.1 * i, 0.067 * i, 0) }
    if (motion == "aside") { for (i = 1; i <= 5; ++i) row(0.1 * i, 0, 0); for (i = 1; i <= 4; ++i) row(0.5, 0.1 * i, 0)
      for (i = 3; i >= -3; --i) row(0.5, 0.1 * i, 0) }
    if (motion == "askew") { for (i = 1; i <= 5; ++i) row(0.13 * i, 0.05 * i, 0.02 * i)
      for (i = 1; i <= 5; ++i) row(0.65, 0.25 - 0.02 * i, 0.1 + 0.08 * i); for (i = 4; i >= 1; --i) row(0.13 * i, 0.15, 0.5) }
  }
  function row(d, p, q) { printf "0,%.2f,%s,%.7f,%.7f,%.7f\n", 0.1 * n++, at, 0.004 * p, 0.004 * q, -0.004 * d }' >$motion.csv
  "$bin/hs-simulate" -q $motion.csv --body block.ply --model slips.csv --full --rim-edge 0.25 -o $motion-full.csv
  for model in held slips; do
    "$bin/hs-simulate" -q $motion.csv --body block.ply --model $model.csv --live --large-strain --accuracy 0.05 \
      --contacts contacts.csv --uncertainty -o $motion-$model.csv
  done
  forces() { awk -F, -v OFS=, '/^#/ { next } !("fx" in c) { for (i = 1; i <= NF; ++i) c[$i] = i; next }
    { print $c["fx"], $c["fy"], $c["fz"], "uncertainty" in c ? $c["uncertainty"] : 0 }' "$1"; }
  paste -d, <(forces $motion-full.csv) <(forces $motion-slips.csv) <(forces $motion-held.csv) | awk -F, -v motion=$motion '
    function off(k) { return sqrt(($1 - $k) ^ 2 + ($2 - $(k + 1)) ^ 2 + ($3 - $(k + 2)) ^ 2) }
    { f[NR] = sqrt($1 ^ 2 + $2 ^ 2 + $3 ^ 2); e[NR] = off(5); h[NR] = off(9); s[NR] = 1.96 * $8; if (f[NR] > peak) peak = f[NR] }
    END { for (r = 2; r <= NR; ++r) { u = f[r] > 0.05 * peak ? f[r] : 0.05 * peak; ++n; covered += e[r] <= s[r]
        x = 100 * e[r] / u; within += x <= 2; sum += x; if (x > worst) worst = x
        x = 100 * h[r] / u; held += x; if (x > held_worst) held_worst = x }
      printf "%-8s mean %.2f %% worst %.2f %%, within 2 %%: %d of %d, covered %d; a held tool: mean %.2f %% worst %.2f %%\n",
        motion, sum / n, worst, within, n, covered, held / n, held_worst }'
done
