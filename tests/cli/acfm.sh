#!/usr/bin/env bash
# acfm.sh BIN: an analytical model identified from the forces of finite elements answers like them,
# in batch and live, without a body; what is refused.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"

"$bin/hs-tetmesh" box.off --edge 0.015 -q -o body.ply || complain 'no body'
cat >model.csv <<'END'
effect,region,parameter,value,unit,std_error,lower,upper,state
elastic,0,E,20000,Pa,,1,1e12,fixed
elastic,0,nu,0.4,1,,0,0.499,fixed
viscoelastic,0,E1,8000,Pa,,0,1e12,fixed
viscoelastic,0,tau1,0.2,s,,0.0001,100000,fixed
END
# Two positions: a fast press with a hold, a slow one, a sideways one; then a place between them.
presses() { # X...
  awk -v xs="$*" 'BEGIN {
    n = split(xs, x, " ")
    print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
    for (k = 1; k <= n; ++k) for (p = 1; p <= 3; ++p)
      for (i = 0; i <= 60; ++i) {
        t = 0.01 * i; s = t / (p == 1 ? 0.1 : 0.5); if (s > 1) s = 1
        printf "%d,%g,%g,0.025,0.04,%g,%g,%g\n", 3 * k + p, t, x[k], (p == 3) * 2e-3 * s, (p == 3) * 1e-3 * s, -2e-3 * s
      }
  }'
}
presses 0.025 0.035 >motion.csv
presses 0.03 >between.csv
fe=(--body body.ply --model model.csv --rim-edge 0.3 -q)
for name in motion between; do
  "$bin/hs-simulate" $name.csv "${fe[@]}" -o $name-fe.csv 2>err || complain 'no forces'
done
"$bin/hs-identify" motion-fe.csv --body body.ply --acfm 1 -o acfm.csv 2>err || complain 'not identified'
flat err | grep -q '2 sub-models of 1 Maxwell elements.*interpolated from the others' ||
  complain 'what was identified is not told'
grep -q '^1,0.025,.*,n,tau1,0.2' acfm.csv || complain 'the relaxation time was not found'
near() { # SIMULATED MEASURED LIMIT
  "$bin/hs-simulate" "$1" --model acfm.csv -q 2>err |
    "$bin/hs-compare" "$2" --simulated - --fail-above "$3" -o residuals.csv 2>>err ||
    complain "the analytical model is off on $1"
}
near motion.csv motion-fe.csv 2% # directions are decoupled, which a body is not quite
near between.csv between-fe.csv 3%

# Live: the batch forces, without a body and from tip positions with one.
"$bin/hs-simulate" motion.csv --model acfm.csv -q -o batch.csv 2>err || complain 'no batch'
"$bin/hs-simulate" --live motion.csv --model acfm.csv --tool-radius 0.004 -q -o live.csv 2>err ||
  complain 'no live forces'
"$bin/hs-compare" batch.csv --simulated live.csv --fail-above 1e-9% -q -o residuals.csv 2>err ||
  complain 'live differs from batch'
printf 't,x,y,z\n0,0.03,0.025,0.041\n0.01,0.03,0.025,0.038\n' |
  "$bin/hs-simulate" --live --model acfm.csv --body body.ply -q >tip.csv 2>err || complain 'no tip'
tail -1 tip.csv | grep -q '^1,0.01,0.03,0.025,0.04,.*,1,0$' || complain 'the contact was not found'

refuse() { # CODE TEXT TOOL ARGUMENTS...
  local code=$1 text=$2 tool=$3 got
  shift 3
  "$bin/$tool" "$@" >/dev/null 2>err </dev/null
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 ]] ||
    complain "exit $got, not $code with '$text': $*"
}
printf 't,x,y,z\n0,0,0,0\n' >between-tip.csv
refuse 3 'those of a moving tip' hs-simulate --live between-tip.csv --model acfm.csv
refuse 2 '--body is required' hs-simulate motion.csv --model model.csv
refuse 2 '--full is of finite elements' hs-simulate motion.csv --model acfm.csv --full
refuse 2 '--add is of models with effects' hs-identify motion-fe.csv --body body.ply --acfm 1 --add tip
refuse 2 '2 windows for 1 elements' hs-identify motion-fe.csv --body body.ply --acfm 1 --windows 0.1:1,2:3
sed '/,t2,k1,/d' acfm.csv >cut.csv
refuse 3 'cut.csv: position 1 has no k1 for axis t2' hs-simulate motion.csv --model cut.csv

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
