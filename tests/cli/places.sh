#!/usr/bin/env bash
# places.sh BIN: a touched patch becomes a body that goes on; places that do not fit are left out; a smooth
# stiffness by place is learned, written as a table, simulated and predicts places left out.
set -uo pipefail
bin=$(cd "$1" && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-identify"
export XDG_CACHE_HOME=$work/cache
# 36 places, 5 mm apart, on a patch that is not flat; pressed along z.
awk 'BEGIN { for (i = 0; i < 6; ++i) for (j = 0; j < 6; ++j) {
  x = .005 * i; y = .005 * j; print x "," y "," .012 + .001 * sin(90 * x) } }' | sed '1i x,y,z' >touched.csv
"$bin/hs-scan2ply" -q touched.csv | "$bin/hs-reconstruct" -q --window --base 0 -o window.ply ||
  complain 'the patch is reconstructed'
"$bin/hs-reconstruct" -q touched.csv --base 0 -o patch.ply || complain 'without going on'
volume() { "$bin/hs-tetmesh" "$1" -o "$2" 2>.err || complain "$1 is meshed"; sed -n 's/.*triangles, \([0-9.e-]*\) m^3.*/\1/p' .err; }
patch=$(volume patch.ply p.ply) window=$(volume window.ply body.ply)
awk -v a="$patch" -v b="$window" 'BEGIN { exit !(b > 1.8 * a) }' || complain "it goes on: $patch, $window m^3"
grep -aq '^comment window ' body.ply || complain 'the body tells the window'
grep -aq '^comment window ' p.ply && complain 'a body that was seen whole tells none'
"$bin/hs-reconstruct" -q touched.csv --base 0 --beyond 2mm -o beyond.ply || complain 'as far as is said'
"$bin/hs-reconstruct" touched.csv --base 0 --method poisson --window -o no.ply 2>.err
[[ $? == 3 ]] && grep -q 'only a patch goes on' .err || complain 'only a patch goes on'

# A stiffness that changes by place, quasi-static; the last place lies on the bonded bottom.
awk -F, 'NR > 1 { for (k = 1; k <= 5; ++k) { d = .0002 * k
    f = 250 * d * (1 + .5 * sin(150 * $1) * cos(110 * $2))
    printf "%d,%g,%g,%g,0,0,%g,%.6f,%.6f,%.6f\n", NR, $1, $2, $3, -d, .0005 * sin(7 * NR + 3 * k), .0005 * cos(5 * NR + 2 * k), f } }
  END { print "99,.01,.01,0,0,0,.0002,0,0,-.05" }' touched.csv |
  sed '1i # tool_radius: 0.002\n# force_noise: 0.0005\npress,x,y,z,ux,uy,uz,fx,fy,fz' >data.csv
common=(data.csv --body body.ply --rim-edge 0.35 --fix nu=0.45)
expect 0 '1 of 37 places are left out' "${common[@]}" --folds 6 -o m0.csv
expect 0 'on positions not seen by the fit' "${common[@]}" --effects elastic,learned-place --folds 6 --field field.csv -o m1.csv
tr -s '\n ' '  ' <.err | grep -q 'at places not pressed, among these, within [0-9.]* % (rms of a place) with a chance of 95 %' ||
  complain 'it says how far it may be off elsewhere'
value() { sed -n "s/^# $2: //p" "$1"; }
awk -v a="$(value m0.csv heldout)" -v b="$(value m1.csv heldout)" 'BEGIN { exit !(b < .3 * a) }' ||
  complain "places left out: $(value m0.csv heldout) N, then $(value m1.csv heldout) N"
head -3 field.csv | grep -q 'x,y,z,pressed,factor,low,high,power,power_sd' || complain 'the table has its columns'
awk -F, '!/^#/ && $4 == 1 { ++n } $4 == 0 && !($6 <= $5 && $5 <= $7) { bad = 1 } END { exit !(n == 36 && !bad) }' field.csv ||
  complain 'the table has every place, and bands'
"$bin/hs-simulate" data.csv --body body.ply --rim-edge 0.35 --model m1.csv -o forces.csv 2>.err || complain 'it is simulated'
grep -q '1 of 37 places are taken for their nearest neighbours' .err || complain 'what does not fit borrows'
grep -q 'UNSEEN   of 37 places 1 not among' .err || complain 'of the places one alone was not fitted to'
awk -F, -v OFS=, '/^#/ || /^press/ { print; next } $1 == 1 { x = $2; y = $3; z = $4 } $1 == 2 { $2 = (x + $2) / 2; $3 = (y + $3) / 2
  $4 = (z + $4) / 2; print }' data.csv >between.csv
"$bin/hs-simulate" between.csv --body body.ply --rim-edge 0.35 --model m1.csv -o between-forces.csv 2>.err ||
  complain 'it is simulated between places'
tr -s '\n ' '  ' <.err | grep -q 'of 1 place 1 not among those' || complain 'a place between others was not seen'
[[ $(value between-forces.csv unseen_band) == "$(value m1.csv unseen_band)" ]] || complain 'the recording says so'
grep -v '^# unseen' m1.csv >mute.csv
"$bin/hs-simulate" -q between-forces.csv --body body.ply --rim-edge 0.35 --model mute.csv -o mute-forces.csv || complain 'a model without a band'
[[ -z $(value mute-forces.csv unseen_band) ]] || complain 'no band is left from another model'
"$bin/hs-compare" -q data.csv --simulated forces.csv -o residuals.csv || complain 'every row has its force'
sed -i '/learned-place,0,h7,/d' m1.csv
expect 3 'lacks rows of its place 7' data.csv --body body.ply --model m1.csv -o no.csv
((failures == 0))
