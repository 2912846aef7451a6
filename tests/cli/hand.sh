#!/usr/bin/env bash
# hand.sh BIN: hs-simulate --live --hand: forces within the limits are what they were, others are cut and
# flagged; without motion they go to zero; a signal and every end send zero last. Nothing here asks for time.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"

"$bin/hs-tetmesh" box.off --edge 0.015 -q -o body.ply || complain 'no body'
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.45,1\n' >model.csv
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  for (i = 0; i < 600; ++i)
    printf "1,%.3f,0.03,0.025,0.04,0,0,%.9g\n", i / 1000, -0.001 * (1 - cos(0.02 * i))
}' >motion.csv
live=("$bin/hs-simulate" --live --accuracy 0.3 --body body.ply --model model.csv)

# Within the limits, to the letter; at the end zero.
"${live[@]}" motion.csv -q -o free.csv 2>err || complain 'no forces'
"${live[@]}" motion.csv --hand --rate 1000 -q -o felt.csv 2>err || complain 'no forces for a hand'
[[ $(grep -c '^1,' felt.csv) == 601 ]] || complain 'not a line each, and the end'
paste -d, <(grep '^1,' free.csv) <(grep '^1,' felt.csv | head -600) | awk -F, '
  $27 == 0 { ++whole; if ($9 != $22 || $10 != $23 || $11 != $24) bad = 1 }
  $9 != $28 || $10 != $29 || $11 != $30 { bad = 1 }
  END { exit bad || whole < 500 }' || complain 'a force within the limits was changed, or the one asked for is not told'
tail -1 felt.csv | awk -F, '{ exit !($9 == 0 && $10 == 0 && $11 == 0 && $14 == 128) }' || complain 'the end is not zero'

# Beyond them.
"${live[@]}" motion.csv --hand --max-force 0.05 --rate 1000 -o cut.csv 2>err || complain 'no cut forces'
grep -q 'safety: force cut in' err || complain 'that forces were cut is not said'
awk -F, '/^1,/ { if (sqrt($9 * $9 + $10 * $10 + $11 * $11) > 0.05) bad = 1; if (int($14) % 2 == 1) ++cut }
  END { exit bad || !cut }' cut.csv || complain 'a force is above its limit'
"${live[@]}" motion.csv --hand --workspace 1,1,1,2,2,2 -q -o out.csv 2>err || complain 'no forces outside'
awk -F, '/^1,/ && ($11 != 0 || (int($14 / 8) % 2 != 1 && $14 != 128)) { bad = 1 } END { exit bad }' out.csv ||
  complain 'a force outside the workspace'

# A motion that rests on the body and does not go on: held, taken to zero, told.
mkfifo slow
"${live[@]}" slow --hand >felt.csv 2>err &
hand=$!
exec {to}>slow
head -159 motion.csv >&"$to"
at_zero() { tail -1 felt.csv | awk -F, '{ zero = /^1,/ && $11 == 0 && int($14 / 64) % 2 == 1 } END { exit !zero }'; }
until_true 60 at_zero || complain 'a force of no motion is held'
exec {to}>&-
wait $hand
[[ $? == 5 ]] && grep -q 'no motion came any more' err || complain 'a motion that stopped is not told'
tail -1 felt.csv | awk -F, '{ exit !($11 == 0 && $14 == 128) }' || complain 'the end of a lost motion is not zero'

# A signal while it presses: zero goes out before the end.
"${live[@]}" slow --hand --hold 2 --ramp 5 >felt.csv 2>err &
hand=$!
exec {to}>slow
head -159 motion.csv >&"$to"
until_true 60 rows_in felt.csv 156 || complain 'live lines are not answered'
kill -TERM $hand
wait $hand || complain 'ended by a signal'
exec {to}>&-
tail -1 felt.csv | awk -F, '{ exit !($11 == 0 && $14 == 128) }' || complain 'a signal leaves a force'

# A bad line: the same.
sed '100s/0.04,/nan,/' motion.csv >bad.csv
"${live[@]}" bad.csv --hand >felt.csv 2>err
[[ $? == 3 ]] && tail -1 felt.csv | awk -F, '{ exit !($11 == 0 && $14 == 128) }' || complain 'a bad line leaves a force'

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-simulate" "$@" >/dev/null 2>err </dev/null
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 ]] ||
    complain "exit $got, not $code with '$text': $*"
}
refuse 2 '--max-force is a limit of --hand' --live motion.csv --body body.ply --model model.csv --max-force 3
refuse 2 '--max-energy is a limit of --hand' --live motion.csv --body body.ply --model model.csv --max-energy 3
refuse 2 '--hand is of the live mode' motion.csv --body body.ply --model model.csv --hand
refuse 2 'records have none' --live --binary tip --hand --body body.ply --model model.csv --tool-radius 0.004
refuse 2 'falls to zero within' --live motion.csv --hand --max-force 500 --body body.ply --model model.csv

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
