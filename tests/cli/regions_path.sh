#!/usr/bin/env bash
# regions_path.sh BIN: from a scan and presses on a body of two materials to its regions, their model
# and its forces: hs-identify --locations, hs-cluster, hs-identify --boundary, hs-simulate, hs-compare.
set -uo pipefail
bin=$(cd "$1" && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-cluster"
export XDG_CACHE_HOME=$work/cache PATH=$bin:$PATH

# A block of 60 x 80 x 25 mm in millimetres, scanned every 2 mm; in metres, what is pressed is the
# block itself.
awk 'BEGIN { print "x,y,z"
  for (i = 0; i <= 30; ++i) for (j = 0; j <= 40; ++j) { print 2*i "," 2*j ",0"; print 2*i "," 2*j ",25" }
  for (k = 1; k < 13; ++k) {
    for (i = 0; i <= 30; ++i) { print 2*i ",0," 2*k; print 2*i ",80," 2*k }
    for (j = 1; j < 40; ++j) { print "0," 2*j "," 2*k; print "60," 2*j "," 2*k } } }' >scan.csv
hs-scan2ply -q scan.csv --unit mm | hs-reconstruct -q | hs-tetmesh -q -o body.ply ||
  complain 'the scan becomes a body'
# 2 x 4 presses, 18 mm apart; 2.5 times stiffer above a slanting boundary.
awk 'BEGIN { print "# tool_radius: 0.004\npress,x,y,z,ux,uy,uz"
  for (j = 0; j < 4; ++j) for (i = 0; i < 2; ++i) for (k = 1; k <= 8; ++k)
    printf "%d,%.3f,%.3f,0.025,0,0,%.5f\n", 2 * j + i, 0.021 + 0.018 * i, 0.013 + 0.018 * j,
           -0.00025 * k }' >motion.csv
awk 'BEGIN { print "effect,region,parameter,value,unit,std_error,lower,upper,state"
  print "elastic,0,E,10000,Pa,,1,1e12,free\nelastic,1,E,25000,Pa,,1,1e12,free"
  print "elastic,0,nu,0.4,1,,0,0.499,fixed"
  for (k = 1; k <= 11; ++k) { x = 0.006 * (k - 1); y = 0.04 + 0.15 * (x - 0.03)
    for (r = 0; r < 2; ++r) {
      printf "regions,%d,x%d,%.5f,m,,-10,10,fixed\n", r, k, x
      printf "regions,%d,y%d,%.5f,m,,-10,10,fixed\n", r, k, y + (r ? 0.002 : -0.002) } } }' >truth.csv
hs-simulate -q motion.csv --body body.ply --model truth.csv --rim-edge 0.25 --add-noise 0.002 \
  -o data.csv || complain 'presses on the truth'
common=(--body body.ply --rim-edge 0.3 --noise 0.002)

hs-identify -q data.csv "${common[@]}" --fix nu=0.4 --folds 0 --locations samples.csv -o m0.csv ||
  complain 'location samples'
expect 0 '2 regions' samples.csv --body body.ply --labels regions.ply --boundary boundary.csv \
  --key-points 5 --write-model start.csv -o classified.csv
awk -F, '!/^[#x]/ { y = 0.04 + 0.15 * ($1 - 0.03)
  if ($9 != ($2 > y)) wrong = 1; ++n } END { exit wrong || n != 8 }' \
  classified.csv || complain 'each position has its region'
sed -i '/,nu,/s/free/fixed/' start.csv
tool=$bin/hs-identify name=hs-identify
expect 0 'boundaries moved by' data.csv --body regions.ply --rim-edge 0.3 --noise 0.002 \
  --model start.csv --refine-boundary 5 --folds 0 -o m1.csv
error() { sed -n 's/^# rmse: //p' "$1"; }
awk -v plain="$(error m0.csv)" -v refined="$(error m1.csv)" 'BEGIN { exit !(refined < 0.2 * plain) }' ||
  complain "the error falls: $(error m0.csv), $(error m1.csv)"
awk -F, '/^elastic,.,E/ { d = $4 / ($2 ? 25000 : 10000) - 1; if (d > 0.04 || d < -0.04) exit 1 }' m1.csv ||
  complain 'the moduli of both regions'
# Whichever region is the stiffer stays that one; a modulus that is held stays what it is.
awk 'BEGIN { FS = OFS = "," } /^elastic,.,E|^regions/ { $2 = 1 - $2 } { print }' start.csv >turned.csv
expect 0 'boundaries moved by' data.csv --body regions.ply --rim-edge 0.3 --noise 0.002 \
  --model turned.csv --refine-boundary 5 --folds 0 -o m2.csv
awk -F, '/^elastic,.,E/ { d = $4 / ($2 ? 10000 : 25000) - 1; if (d > 0.04 || d < -0.04) exit 1 }' m2.csv ||
  complain "the regions' order: $(grep '^elastic,.,E' m2.csv)"
awk 'BEGIN { FS = OFS = "," } /^elastic,1,E/ { $4 = 23000; $NF = "fixed" } { print }' start.csv >held.csv
expect 0 '' data.csv --body regions.ply --rim-edge 0.3 --noise 0.002 --model held.csv --refine-boundary 5 --folds 0 -o m3.csv
grep -q '^elastic,1,E,23000,.*fixed' m3.csv || complain "a modulus that is held: $(grep '^elastic,1,E' m3.csv)"
# Nobody says that there are regions: they are found, and their boundary moved.
expect 0 'boundaries ' data.csv "${common[@]}" --fix nu=0.4 --effects auto --refine-boundary 5 -o m4.csv
awk -v plain="$(error m0.csv)" -v found="$(error m4.csv)" 'BEGIN { exit !(found < 0.2 * plain) }' ||
  complain "the error of what is found: $(error m0.csv), $(error m4.csv)"
# Labelled or not, the body is the same: the model has the boundary.
for body in body regions; do
  hs-simulate -q data.csv --body $body.ply --model m1.csv --rim-edge 0.3 -o $body-forces.csv ||
    complain "forces on $body.ply"
done
cmp -s body-forces.csv regions-forces.csv || complain 'labels change no force'
hs-compare -q data.csv --simulated regions-forces.csv -o residuals.csv || complain 'the comparison'
expect 3 'the model has no boundary between regions' data.csv "${common[@]}" --model m0.csv \
  --refine-boundary 5 --folds 0 -o no.csv
[[ ! -e no.csv ]] || complain 'a refused run leaves nothing behind'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
