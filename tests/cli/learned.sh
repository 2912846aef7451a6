#!/usr/bin/env bash
# learned.sh BIN: causes that no effect has a name for. What depth or time do is learned as a curve, added, written
# with its band, and foretells positions left out; the simulation has it.
set -uo pipefail
bin=$(cd "$1" && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-diagnose"
export XDG_CACHE_HOME=$work/cache
awk 'BEGIN { print "OFF\n8 12 0"
  for (k = 0; k < 2; ++k) for (j = 0; j < 2; ++j) for (i = 0; i < 2; ++i) print .1 * i, .08 * j, .04 * k
  print "3 0 3 1\n3 0 2 3\n3 4 5 7\n3 4 7 6\n3 0 1 5\n3 0 5 4\n3 2 7 3\n3 2 6 7\n3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5" }' >box.off
"$bin/hs-tetmesh" -q box.off -o body.ply || complain 'no body'
# Eight places, in and out again, a hold between; air before and after.
awk 'BEGIN { print "# tool_radius: 0.004\n# units: SI\npress,x,y,z,t,ux,uy,uz"
  for (p = 0; p < 8; ++p) for (i = -8; i <= 68; ++i) {
    w = i < 0 ? i / 8 : i <= 30 ? i / 30 : i <= 38 ? 1 : (68 - i) / 30
    d = .003 * (w > 0 ? w : .2 * w)
    printf "%d,%g,%g,.04,%.3f,0,0,%.6g\n", p, .02 + .02 * (p % 4), .025 + .03 * int(p / 4), 4 * p + .03 * (i + 8), -d } }' >motion.csv
printf 'effect,region,parameter,value,unit,std_error,lower,upper,state\nelastic,0,E,2e4,Pa,,1,1e12,free\nelastic,0,nu,0.42,1,,0,0.499,fixed\n' >true.csv
"$bin/hs-simulate" -q motion.csv --body body.ply --model true.csv -o forces.csv || complain 'no forces'
# changed NAME AWK: the forces as the cause leaves them (f[1..3], depth d [m], time t [s]), and noise.
changed() {
  awk -F, -v OFS=, -v seed=7 'function noise() { return .002 * sqrt(-2 * log(1 - rand())) * cos(6.2831853 * rand()) }
    BEGIN { srand(seed) } /^#/ { print; next }
    !h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; print; next }
    { t = $c["t"]; d = -$c["uz"]; f[1] = $c["fx"]; f[2] = $c["fy"]; f[3] = $c["fz"]; '"$2"'
      $c["fx"] = f[1] + noise(); $c["fy"] = f[2] + noise(); $c["fz"] = f[3] + noise(); print }' forces.csv >"$1.csv"
}
changed depth 'if (d > 0) { g = exp(.25 * sin(5 * d / .003)); for (i = 1; i <= 3; ++i) f[i] *= g }'
changed zero 'f[3] += .03 * sin(.2 * t); f[1] += .015 * cos(.17 * t)'
changed nothing ''
for cause in depth zero nothing; do
  "$bin/hs-identify" -q $cause.csv --body body.ply --effects elastic --fix nu=0.42 -o $cause-m0.csv || complain "$cause: no model"
done
names() { awk -F, '$3 == "missing" || $3 == "indistinguishable" { printf "%s ", $2 }' "$1"; }
expect 0 'incomplete' depth.csv --body body.ply --model depth-m0.csv -o effects.csv
[[ $(names effects.csv) == 'learned-depth ' ]] || complain "depth: $(names effects.csv)"
grep -q 'factor .* at .* mm' effects.csv || complain 'the curve is told'
expect 0 'incomplete' zero.csv --body body.ply --model zero-m0.csv -o effects.csv
[[ $(names effects.csv) == 'learned-drift ' ]] || complain "zero: $(names effects.csv)"
expect 0 'complete' nothing.csv --body body.ply --model nothing-m0.csv -o effects.csv
[[ $(names effects.csv) == '' ]] || complain "nothing: $(names effects.csv)"

"$bin/hs-identify" -q depth.csv --body body.ply --model depth-m0.csv --effects auto --history steps.csv --curves curve.csv -o m1.csv ||
  complain 'it is not added'
grep -q '^learned-depth,' m1.csv || complain 'the model has not what was learned'
value() { sed -n "s/^# $2: //p" "$1"; }
awk -v a="$(value depth-m0.csv heldout)" -v b="$(value m1.csv heldout)" 'BEGIN { exit !(b < .2 * a) }' ||
  complain "positions left out: $(value depth-m0.csv heldout) N, then $(value m1.csv heldout) N"
# The truth over its value at the deepest depth, where the modulus takes it: inside the band nearly everywhere.
awk -F, 'function truth(d) { return exp(.25 * (sin(5 * d / .003) - sin(5))) }
  $1 == "learned-depth" && $3 > 3e-4 { ++n; if ($7 <= truth($3) && truth($3) <= $8) ++in_band; e = $5 / truth($3) - 1; if (e * e > w) w = e * e }
  END { printf "%d of %d points in the band, at most %.1f %% off\n", in_band, n, 100 * sqrt(w); exit !(n > 30 && in_band >= .9 * n && w < .03 ^ 2) }' curve.csv ||
  complain 'the curve is not the truth'
"$bin/hs-simulate" -q depth.csv --body body.ply --model m1.csv -o again.csv && "$bin/hs-compare" -q depth.csv --simulated again.csv \
  --model m1.csv --body body.ply --html report.html -o residuals.csv || complain 'it is not simulated and drawn'
grep -q 'Learned: factor over depth' report.html || complain 'the report draws the curve'
"$bin/hs-identify" -q depth.csv --body body.ply --effects elastic --fix nu=0.42 --curves no.csv -o no-m.csv 2>.err
[[ $? == 2 ]] && grep -q 'this model has none' .err || complain 'nothing was learned'
((failures == 0))
