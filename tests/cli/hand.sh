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

# Two tools that turn: limits each, a torque with them; one of which nothing comes is lost alone.
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "# tools: 2"; print "t,tool_id,x,y,z,thx,thy,thz"
  for (i = 0; i < 400; ++i) for (k = 0; k < 2; ++k)
    printf "%.3f,%s,%g,0.025,%.9g,0,0,%g\n", i / 1000, k ? "b" : "a", 0.015 + 0.03 * k, 0.0405 - 0.002 * sin(0.008 * i), 0.1 * sin(0.01 * i)
}' >tools.csv
"${live[@]}" tools.csv -q -o free.csv 2>err || complain 'no forces of two tools'
"${live[@]}" tools.csv --hand --rate 1000 -q -o felt.csv 2>err || complain "no forces of two tools for hands: $(cat err)"
head -20 felt.csv | grep -q 'contact,beyond,safety,ax,ay,az,atqx,atqy,atqz$' || complain 'columns of several tools for hands'
paste -d, <(grep -v '^#' free.csv | tail -n +2) <(grep -v '^#' felt.csv | tail -n +2 | head -800) | awk -F, '
  { for (k = 0; k < 20; ++k) if ($41 == 0 && $(k + 1) != $(21 + k)) bad = 1 }
  $41 == 0 && $19 == 1 { ++whole }
  END { exit bad || whole < 500 || NR != 800 }' || complain 'forces of several tools within the limits were changed'
tail -2 felt.csv | awk -F, '$13 != 0 || $14 != 0 || $15 != 0 || $16 != 0 || $18 != 0 || $21 != 128 { bad = 1 } END { exit bad }' ||
  complain 'the end of several tools is not zero'
"${live[@]}" tools.csv --hand --max-force 0.05 -o cut.csv 2>err || complain 'no cut forces of several tools'
awk -F, '!/^#/ && NF == 27 && $1 ~ /^-?[0-9]/ { f = sqrt($13 ^ 2 + $14 ^ 2 + $15 ^ 2); q = sqrt($16 ^ 2 + $17 ^ 2 + $18 ^ 2)
  if (f > 0.05 || q > 0.0015) bad = 1; if ($21 % 2 == 1) ++cut } END { exit bad || !cut }' cut.csv || complain 'a force of several tools is above its limit'

# Records: why a force was cut stands in contact, the last is zero.
python=/usr/bin/python3
"$python" -c '
import math, struct, sys
for i in range(600):
    sys.stdout.buffer.write(struct.pack("<4d", i / 1000, 0.03, 0.025, 0.0405 - 0.002 * math.sin(0.005 * i)))' >motion.bin
records=("$bin/hs-simulate" --live --accuracy 0.3 --body body.ply --model model.csv --binary tip --tool-radius 0.004 -q)
"${records[@]}" motion.bin -o free.bin && "${records[@]}" motion.bin --hand --rate 1000 -o felt.bin &&
  "${records[@]}" motion.bin --hand --max-force 0.05 -o cut.bin || complain 'no records for a hand'
"$python" - <<'END' || complain 'records for a hand'
import math, struct
def records(name):
    data = open(name, "rb").read()
    assert len(data) % 88 == 0
    return [(struct.unpack("<2i", data[i:i + 8]), data[i:i + 88], struct.unpack("<3d", data[i + 64:i + 88])) for i in range(0, len(data), 88)]
free, felt, cut = (records(n) for n in ("free.bin", "felt.bin", "cut.bin"))
assert len(free) == 600 and len(felt) == 601, (len(free), len(felt))
assert all((f[0][1] >> 8) != 0 or f[1] == g[1] for f, g in zip(felt, free))
assert sum(f[0][1] == 1 for f in felt) > 400
assert felt[-1][2] == (0, 0, 0) and felt[-1][0][1] >> 8 == 128
assert all(math.hypot(*c[2]) <= 0.05 for c in cut) and any(c[0][1] >> 8 & 1 for c in cut)
END

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
refuse 2 'falls to zero within' --live motion.csv --hand --max-force 500 --body body.ply --model model.csv

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
