#!/usr/bin/env bash
# follow.sh BIN: hs-identify --follow finds the modulus, hs-compare --follow answers row by row, notices a changed stiffness and a changed
# zero of the sensor, names them and goes on with them.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"

"$bin/hs-tetmesh" box.off --edge 0.015 -q -o body.ply || complain 'no body'
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.45,1\n' >model.csv
awk 'BEGIN { # presses of a second at 200 Hz, with air between them
  print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz,contact"
  for (p = 1; p <= 24; ++p) for (i = 0; i < 200; ++i) {
    s = sin(3.14159 * i / 160) ^ 2; air = i >= 160
    printf "%d,%.3f,%g,%g,0.04,%.9g,0,%.9g,%d\n", p, p + i / 200, 0.02 + 0.005 * (p % 5), 0.02 + 0.003 * (p % 4), air ? 0 : 0.0006 * s, air ? 0.01 : -0.003 * s, !air
  }
}' >motion.csv
"$bin/hs-simulate" --live --accuracy 0.3 motion.csv --body body.ply --model model.csv -q -o clean.csv 2>err || complain 'no forces'
stream() { # KIND: noise, and after 14 s the change
  awk -F, -v OFS=, -v kind="$1" 'BEGIN { srand(3) } /^#/ { print; next } !h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; print; next }
    { for (k = 0; k < 3; ++k) { f = c["fx"] + k; g = -6; for (j = 0; j < 12; ++j) g += rand()
        if ($c["t"] > 14 && kind == "soft") $f *= 0.7
        if ($c["t"] > 14 && kind == "bias" && k == 2) $f += 0.1
        $f = sprintf("%.6f", $f + 0.01 * g) } print }' clean.csv
}
follow() { stream "$1" | "$bin/hs-compare" --follow --accuracy 0.3 - --body body.ply --model model.csv --rate 200 \
  --learning 6 --events "$1.events" >"$1.out" 2>err || complain "$1 was not followed"; }
for kind in none soft bias; do
  follow $kind
  [[ $(grep -c '^[0-9]' $kind.out) == 4800 ]] || complain 'not every row was answered'
done
[[ $(wc -l <none.events) == 1 ]] || complain 'an alarm without a change'
awk -F, 'NR == 2 { exit !($4 == "material" && $5 > 0.65 && $5 < 0.75 && $2 > 14 && $2 < 16) }' soft.events ||
  complain 'the softer body was not named'
awk -F, 'NR == 2 { exit !($4 == "sensor" && $8 > 0.08 && $8 < 0.12) }' bias.events ||
  complain 'the bias was not named'
for kind in soft bias; do # the last 4 s: noise alone is left
  awk -F, '/^#/ || !n++ { next } $2 > 21 { s += $16 ^ 2 + $17 ^ 2 + $18 ^ 2; m += 3 } END { exit !(m > 0 && sqrt(s / m) < 0.013) }' $kind.out ||
    complain "the model did not go on with it: $kind"
done

# Ended by a signal while it waits, or by a bad row: what was answered and noticed stays.
mkfifo pipe
answered() { # every row of the stream, in the file that will be rows.csv
  local file
  for file in .hapsim-*.tmp; do rows_in "$file" 4800 && return; done
}
for signal in INT TERM; do
  rm -f rows.csv soft.events err  # words of the run before must not be waited for
  env --default-signal=INT "$bin/hs-compare" --follow --accuracy 0.3 pipe --body body.ply --model model.csv --rate 200 \
    --learning 6 --events soft.events -o rows.csv 2>err &
  watching=$!
  exec {to}>pipe
  { stream soft; printf '25,30'; } >&"$to"
  until_true 60 grep -qs 'stiffness by a factor' err && until_true 60 answered || complain 'the rows are not answered'
  kill -$signal $watching
  wait $watching || complain "exit $? after SIG$signal"
  exec {to}>&-
  grep -q 'ended by a signal' err && [[ $(grep -c '^[0-9]' rows.csv) == 4800 && $(wc -l <soft.events) == 2 ]] ||
    complain "SIG$signal loses rows or events"
done
rm -f rows.csv soft.events
{ stream soft; echo 'x,30,0,0,0,0,0,0,0,0,0,1'; } | "$bin/hs-compare" --follow --accuracy 0.3 - --body body.ply --model model.csv \
  --rate 200 --learning 6 --events soft.events -o rows.csv -q 2>err
(($? == 3)) && [[ $(grep -c '^[0-9]' rows.csv) == 4800 && $(wc -l <soft.events) == 2 ]] || complain 'a bad row loses those before it'
# Nothing was watched, and that is told.
stream none | "$bin/hs-compare" --follow --accuracy 0.3 - --body body.ply --model model.csv --rate 200 --learning 60 >rows.csv 2>err
grep -q 'nothing was watched: the usual error is learned from 60 s in contact, and there were 19.2 s' err || complain 'no word of learning'

# The modulus from a stream, line by line.
stream none | "$bin/hs-identify" --follow --accuracy 0.3 - --body body.ply --every 400 >estimates.csv 2>err || complain 'no estimates'
[[ $(grep -c '^[0-9]' estimates.csv) == 12 ]] || complain 'not a line every 400 rows'
awk -F, '/^[0-9]/ { e = $3; s = $4 } END { exit !(e > 19980 && e < 20020 && s > 0 && s < 10) }' estimates.csv ||
  complain 'E was not found'
"$bin/hs-identify" clean.csv --body body.ply --every 3 -q >out.csv 2>err
(($? == 2)) && grep -q 'is of a stream' err || complain '--every without --follow'

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-compare" "$@" >/dev/null 2>err </dev/null
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 ]] ||
    complain "exit $got, not $code with '$text': $*"
}
refuse 2 '--follow needs --model' --follow clean.csv --body body.ply
refuse 2 'is of a stream' clean.csv --simulated clean.csv --events e.csv
refuse 2 '--simulated is required' clean.csv
refuse 3 'the rows come at some 200 Hz by their t, not 1000 Hz' --follow clean.csv --accuracy 0.3 --body body.ply --model model.csv
awk -F, -v OFS=, '$2 == 6.5 { $8 = -0.3 } 1' clean.csv >deep.csv
refuse 3 'a displacement of 0.3 m on a body of 0.0877 m' --follow deep.csv --accuracy 0.3 --body body.ply --model model.csv --rate 200 -q
refuse 3 "'fx'" --follow motion.csv --accuracy 0.3 --body body.ply --model model.csv

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
