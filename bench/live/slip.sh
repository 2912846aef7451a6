#!/usr/bin/env bash
# slip.sh BIN OUT: what a tool that slips (friction 0.4) takes from the normal force at finite strain. A block
# 80 x 60 x 30 mm that stiffens (s = 0.2), a tool of 4 mm, 1.4 mm deep (0.35 radii), straight down and with 0.67 of that
# aside: hs-simulate --full held and slipping, and --live --large-strain, which is pressed held and flags every row.
# Places stay in OUT/cache. Recorded in bench/results/large-strain.txt (bench/record.sh).
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
deepest() { awk -F, '/^#/ { next } !c { for (i = 1; i <= NF; ++i) if ($i == "fz") c = i; next } { f = $c } END { printf "%.4f", f }' "$1"; }
for aside in 0 0.67; do
  awk -v aside="$aside" 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
    for (i = 0; i <= 7; ++i) printf "0,%.2f,0.04,0.034,0.03,%.7f,0,%.7f\n", 0.1 * i, aside * 2e-4 * i, -2e-4 * i }' >motion.csv
  for model in held slips; do
    "$bin/hs-simulate" -q motion.csv --body block.ply --model $model.csv --full -o full-$model.csv
    "$bin/hs-simulate" -q motion.csv --body block.ply --model $model.csv --live --large-strain --accuracy 0.1 \
      --contacts motion.csv -o live-$model.csv
  done
  echo "$aside aside: full held $(deepest full-held.csv) N, slipping $(deepest full-slips.csv) N;" \
    "live held $(deepest live-held.csv) N, slipping $(deepest live-slips.csv) N"
done
