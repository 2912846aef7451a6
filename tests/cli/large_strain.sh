#!/usr/bin/env bash
# large_strain.sh BIN: hs-simulate --live --large-strain presses beforehand, goes on where it was ended, and says what it
# reached and where it was not pressed so far.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
"$bin/hs-tetmesh" box.off --edge 0.012 -q -o body.ply || complain 'no body'
cat >model.csv <<'END'
effect,region,parameter,value,unit,std_error,lower,upper,state
elastic,0,E,20000,Pa,,1,1e12,fixed
elastic,0,nu,0.4,1,,0,0.499,fixed
viscoelastic,0,E1,8000,Pa,,0,1e12,fixed
viscoelastic,0,tau1,0.2,s,,0.0001,100000,fixed
hyperelastic,0,s,0.2,1,,0,1.2,fixed
hyperelastic,0,finite,1,1,,0,1,fixed
END
awk 'BEGIN {
  print "# tool_radius: 0.008"; print "press,t,x,y,z,ux,uy,uz"
  for (i = 0; i <= 30; ++i) printf "1,%g,0.03,0.025,0.04,%g,0,%g\n", 0.02 * i, 2e-5 * i, -6e-4 * i
}' >motion.csv
common=(--live --accuracy 1 --body body.ply --model model.csv --contacts motion.csv --rim-edge 0.5 --threads 2 motion.csv)
pressed() { find cache -name '*.strain' 2>/dev/null | wc -l; }
some_pressed() { (($(pressed) >= 2)); }

# Ended on the way; what was pressed by then is kept.
"$bin/hs-simulate" "${common[@]}" --large-strain --uncertainty -o killed.csv 2>err &
working=$!
until_true 400 some_pressed || complain 'no place is kept'
kill -TERM $working
wait $working 2>/dev/null && complain 'a start that was ended says that all is well'
[[ ! -s killed.csv ]] || complain 'an output of a start that was ended'
for turn in first second; do
  "$bin/hs-simulate" "${common[@]}" --large-strain --uncertainty -o $turn.csv 2>$turn.txt || complain "the $turn start"
done
cmp -s first.csv second.csv || complain 'what the cache keeps is something else'
grep -q 'large strain: 8 places pressed, forces at places left out [0-9.]* % off' second.txt || complain 'what was reached'
(($(pressed) == 8)) || complain "$(pressed) places, not 8"
# Flagged beyond 0.35 of the way through (14 mm) alone, and every force has its uncertainty.
awk -F, '/^[0-9]/ { deep = -$8; flagged = int($13 / 32) % 2
    if ((deep > 0.0141 && !flagged) || (deep < 0.0139 && flagged) || !($14 >= 0)) ++wrong; ++n }
  END { exit !(n == 31 && !wrong) }' first.csv || complain 'where it was not pressed so far'
"$bin/hs-simulate" "${common[@]}" -o law.csv 2>err || complain 'the law'
cmp -s first.csv law.csv && complain 'the law is what it was asked to replace'

# A tool that slips is pressed too, less deep, bears less, and is flagged deeper; the places are the same.
{ cat model.csv; echo 'friction,0,mu,0.4,1,,0.001,1000,fixed'; } >slips.csv
for turn in slips again; do
  "$bin/hs-simulate" "${common[@]/model.csv/slips.csv}" --large-strain --uncertainty -o $turn-out.csv 2>$turn.txt ||
    complain 'a tool that slips'
done
cmp -s slips-out.csv again-out.csv || complain 'what the cache keeps of slip is something else'
deepest=$(sed -n 's/.*slips was pressed to \([0-9.]*\) of its radius.*/\1/p' slips.txt)
[[ -n $deepest ]] || complain 'how deep a tool that slips was pressed is not said'
(($(pressed) == 8)) || complain 'places are pressed anew for a tool that slips'
paste -d, first.csv slips-out.csv | awk -F, -v deepest="${deepest:-0}" '/^[0-9]/ { deep = -$8 / 0.008
    flagged = int($27 / 32) % 2
    if ((deep > deepest + 0.01 && !flagged) || (deep > 0 && deep < deepest - 0.01 && flagged)) ++wrong
    if (deep > 0.3 && !flagged && !($25 < $11)) ++wrong
    if (!($28 >= 0)) ++wrong
    ++n }
  END { exit !(n == 31 && !wrong) }' || complain 'what a tool that slips bears'

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-simulate" "$@" >/dev/null 2>err
  got=$?
  ((got == code)) && grep -qF -- "$text" err || complain "exit $got, not $code with '$text': $*"
}
grep -v hyperelastic model.csv >linear.csv
refuse 2 'live mode' motion.csv --body body.ply --model model.csv --large-strain
refuse 3 'no finite strain' --live --large-strain --accuracy 1 --rim-edge 0.5 motion.csv --contacts motion.csv \
  --body body.ply --model linear.csv

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
