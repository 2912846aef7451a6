#!/bin/sh
# explore.sh [FOLDER [HIDDEN]]: a closed loop of measuring on a simulated robot. HIDDEN is what the body has and the
# loop does not know: relaxing (the default), friction, lump, regions or nothing. Needs hapsim's tools on the PATH; writes into
# FOLDER (here). One line a round on standard output, and at the end the model and report.html.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-.}"
hidden=${2:-relaxing}
rm -rf truth && mkdir truth

# The robot's side: the body as it is, on a mesh of its own.
awk -v what=cuboid -v a=0.08 -v b=0.06 -v c=0.03 -f "$here/../shapes.awk" >block.off
hs-tetmesh -q block.off -o truth/body.ply
{
  printf 'effect,region,parameter,value\nelastic,0,E,15000\nelastic,0,nu,0.42\n'
  case $hidden in
    relaxing) printf 'viscoelastic,0,E1,6000\nviscoelastic,0,tau1,0.6\n' ;;
    friction) printf 'friction,0,mu,0.25\n' ;;
    lump) printf 'inclusion,0,x,0.048\ninclusion,0,y,0.034\ninclusion,0,z,0.021\ninclusion,0,radius,0.005\ninclusion,0,ratio,8\n' ;;
    regions) printf 'elastic,1,E,35000\nregions,0,x1,0.030\nregions,0,y1,0.026\nregions,1,x1,0.050\nregions,1,y1,0.034\n' ;;
    nothing) ;;
    *) echo "explore.sh: no hidden effect $hidden; relaxing, friction, lump, regions or nothing" >&2; exit 2 ;;
  esac
} >truth/model.csv

# The loop's side: a scan of it, three sides of a block.
awk 'BEGIN { srand(4); print "# unit: mm\nx,y,z"
  for (k = 0; k < 1500; ++k) {
    s = rand(); t = rand(); e = 0.1 * (rand() - 0.5)
    if (k % 15 < 7) printf "%.3f,%.3f,%.3f\n", 80 * s, 60 * t, 30 + e
    else if (k % 15 < 11) printf "%.3f,%.3f,%.3f\n", 80 * s, (k % 2) * 60 + e, 30 * t
    else printf "%.3f,%.3f,%.3f\n", (k % 2) * 80 + e, 60 * s, 30 * t } }' >scan.csv
hs-scan2ply -q scan.csv --unit mm | hs-reconstruct -q | hs-tetmesh -q -o body.ply

case $hidden in lump) goals=lump=3mm ;; regions) goals=unseen=2 ;; *) goals=verdict,E=3% ;; esac
of() { sed -n "s/^  \"$1\": \"\{0,1\}\(.*[^\",]\)\"\{0,1\},\{0,1\}\$/\1/p" plan.json; }
value() { awk '/"goal":/ { gsub(/[",]/, ""); name = $2 (NF > 2 ? " " $3 : "") }
  /"said":/ { gsub(/.*: "|",$/, ""); said = $0 }
  /"value":/ { gsub(/,/, ""); if (said != "") print said; if ($2 ~ /[0-9]/ && $2 > 0) print name " " $2 }' plan.json | paste -sd ';'; }
round() { printf '%2d presses; %s; next: %s\n' "$(of presses)" "$(value)" "$(of why)"; }

: >data.csv
count=6
while hs-plan -q data.csv --body body.ply --tool-radius 4mm --goal $goals --presses $count --more \
  --json plan.json -o next.csv; do
  round
  "$here/robot.sh" truth next.csv >>data.csv
  count=2
done
[ "$(of reached)" = true ] || { round; echo 'explore.sh: the goals are not reached' >&2; exit 1; }
printf '%2d presses; %s; reached\n' "$(of presses)" "$(value)"

# What the presses say in the end.
if [ "$hidden" = lump ]; then
  hs-identify data.csv --body body.ply --folds 0 --lumps lumps.csv -o model.csv
else
  # A boundary between regions, if there is one, is moved together with the moduli beside it.
  hs-identify data.csv --body body.ply --effects auto --refine-boundary 8 -o model.csv
fi
hs-simulate -q data.csv --body body.ply --model model.csv | hs-compare data.csv --simulated - --html report.html -o residuals.csv
