#!/usr/bin/env bash
# link.sh BIN: an operator and a teleoperator over this machine's own network: the body is identified
# while the loop runs, strangers' packets change nothing, what is refused. Nothing here asks for time.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"

"$bin/hs-tetmesh" box.off --edge 0.015 -q -o body.ply || complain 'no body'
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.45,1\n' >model.csv
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  for (i = 0; i < 1500; ++i)
    printf "1,%.3f,0.03,0.025,0.04,0,0,%.9g\n", i / 1000, -0.001 * (1 - cos(0.02 * i))
}' >motion.csv

"$bin/hs-link" --listen 0 --accuracy 0.3 --body body.ply --model model.csv --tool-radius 0.004 --delay 0.02 \
  --loss 0.02 --idle 20 2>far.err &
far=$!
until_true 60 grep -qs listening far.err
port=$(sed -n 's/.*listening at 127.0.0.1:\([0-9]*\).*/\1/p' far.err)
[[ -n $port ]] || complain 'the teleoperator does not say where it listens'
for text in x HSL1 "$(printf 'HSL2%092d' 7)" "$(printf 'HSL1%092d' 7)"; do printf '%s' "$text" >/dev/udp/127.0.0.1/"$port"; done
"$bin/hs-link" motion.csv --accuracy 0.3 --peer "$port" --body body.ply --delay 0.02 --jitter 0.005 --loss 0.02 \
  --samples 200 --identified identified.csv >felt.csv 2>err || complain 'the operator failed'
wait $far || complain 'the teleoperator failed'
[[ $(grep -c '^1,' felt.csv) == 1500 ]] || complain 'not every line was answered'
grep -q '4 foreign, 0 malformed, 1 session' far.err || { complain 'strangers are not counted'; cat far.err; }
awk -F, '/^elastic,0,E,/ { exit !($4 > 19990 && $4 < 20010) }' identified.csv || complain 'E was not found'
awk -F, '/^#/ { next } !n++ { next } { f = $11; p = $16 } END { exit !(p == 1 && f > 0) }' felt.csv ||
  complain 'the identified body is not felt'
awk -F, '/^#/ { next } !n++ { next } $17 == 0 && ($9 != $18 || $10 != $19 || $11 != $20) { bad = 1 } END { exit bad }' felt.csv ||
  complain 'a force within the limits was changed'
grep -q 'energy: the hand put in .* ahead (bound 75)' err || complain 'the energy is not told'
awk -F, '/^1,/ { for (k = 0; k < 3; ++k) if (n) e -= f[k] * ($(6 + k) - u[k]); ++n
  for (k = 0; k < 3; ++k) { u[k] = $(6 + k); f[k] = $(9 + k) }
  if ($21 - e > 1e-9 || e - $21 > 1e-9) bad = 1 } END { exit bad || !n }' felt.csv || complain 'column energy is not the work of the hand'
awk -F, '/^1,/ && $22 != "" { if ($2 - $22 < 0.0199 || $22 < last) bad = 1; last = $22; ++n } END { exit bad || n < 1000 }' felt.csv ||
  complain 'column mt is not the time of what the force answers'

# teleoperator ARGUMENTS...: in the background, its process in `far` and its port in `port`
teleoperator() {
  : >far.err
  "$bin/hs-link" --listen 0 --accuracy 0.3 --body body.ply --model model.csv --tool-radius 0.004 --idle 600 "$@" 2>far.err &
  far=$!
  until_true 60 grep -qs listening far.err
  port=$(sed -n 's/.*listening at .*:\([0-9]*\)$/\1/p' far.err)
}
# With a key, by name and by IPv6. Who has another key is nobody.
"$bin/hs-link" --make-key lab.key -q && "$bin/hs-link" --make-key other.key -q || complain 'no key'
[[ $(stat -c %a lab.key) == 600 && $(wc -c <lab.key) == 65 ]] || complain 'a key is for its owner'
head -400 motion.csv >short.csv
teleoperator --key lab.key
"$bin/hs-link" short.csv --peer "localhost:$port" --accuracy 0.3 --body body.ply --key other.key --patience 0.5 >felt.csv 2>err
[[ $? == 5 ]] && grep -q 'nothing answered' err || complain 'another key is answered'
"$bin/hs-link" short.csv --peer "$port" --accuracy 0.3 --body body.ply --patience 0.5 >felt.csv 2>err
[[ $? == 5 ]] || complain 'no key is answered'
"$bin/hs-tetmesh" <(awk 'NR > 2 && NF == 3 { $3 *= 4 } { print }' box.off) --edge 0.03 -q -o tall.ply || complain 'no tall body'
"$bin/hs-link" short.csv --peer "$port" --accuracy 0.3 --body tall.ply --key lab.key >felt.csv 2>err
[[ $? == 3 ]] && grep -q 'the teleoperator refuses: its body is another' err || complain 'another body is taken'
"$bin/hs-link" short.csv --peer "$port" --accuracy 0.3 --body body.ply --key lab.key --tool-radius 0.005 >felt.csv 2>err
[[ $? == 3 ]] && grep -q 'its tool has a radius of 4 mm and this one 5 mm' err || complain 'another tool is taken'
sed 's/20000/30000/' model.csv >stiff.csv
"$bin/hs-link" short.csv --peer "$port" --accuracy 0.3 --body body.ply --key lab.key --expect-model stiff.csv >felt.csv 2>err
[[ $? == 3 ]] && grep -q 'its model is another' err || complain 'another model is taken'
"$bin/hs-link" short.csv --peer "localhost:$port" --accuracy 0.3 --body body.ply --key lab.key --expect-model model.csv \
  >felt.csv 2>err || complain 'the right key is refused'
# Killed while it is felt: the force is zero after hold and ramp, and the code says it.
"$bin/hs-link" motion.csv --peer "$port" --accuracy 0.3 --body body.ply --key lab.key >felt.csv 2>err &
near=$!
until_true 60 rows_in felt.csv 500
kill -KILL $far
wait $near
[[ $? == 5 ]] && grep -q 'was silent at the end' err || complain 'a teleoperator that is gone is not told'
awk -F, '/^1,/ { f = $11; s = $17 } END { exit !(f == 0 && int(s / 64) % 2 == 1) }' felt.csv ||
  complain 'a force of nobody is held'
wait $far 2>/dev/null
# Over IPv6, each line as it comes; a signal ends it with zero.
if [[ -e /proc/net/if_inet6 ]] && grep -q '^0*1 ' /proc/net/if_inet6; then
  mkfifo live
  : >far.err
  "$bin/hs-link" --listen '[::1]:0' --accuracy 0.3 --body body.ply --model model.csv --tool-radius 0.004 --key lab.key --idle 600 2>far.err &
  far=$!
  until_true 60 grep -qs listening far.err
  port=$(sed -n 's/.*listening at .*:\([0-9]*\)$/\1/p' far.err)
  "$bin/hs-link" live --peer "[::1]:$port" --accuracy 0.3 --body body.ply --key lab.key --rate 0 >felt.csv 2>err &
  near=$!
  exec {to}>live
  head -300 motion.csv >&"$to"
  until_true 60 rows_in felt.csv 298 || complain 'a live motion is not answered before its end'
  kill -TERM $near
  wait $near || complain 'ended by a signal'
  exec {to}>&-
  awk -F, '/^1,/ { f = $9 $10 $11; s = $17 } END { exit !(f == "000" && int(s / 128) % 2 == 1) }' felt.csv ||
    complain 'the last that is sent is zero'
  kill -TERM $far
  wait $far || complain 'the teleoperator ends by a signal'
fi

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-link" "$@" >/dev/null 2>err </dev/null
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 ]] ||
    complain "exit $got, not $code with '$text': $*"
}
refuse 2 'either a teleoperator or an operator' --body body.ply
refuse 2 "'host:' is not an address" motion.csv --peer host: --body body.ply
refuse 2 '--body is required' motion.csv --peer 1
refuse 2 '0.0.0.0:0 is not this machine, and there is no key' --listen 0.0.0.0:0 --body body.ply --model model.csv --tool-radius 0.004
refuse 2 '192.0.2.1:9 is not this machine, and there is no key' motion.csv --peer 192.0.2.1:9 --body body.ply
refuse 5 'lab.key: is there already' --make-key lab.key
chmod 644 other.key
refuse 5 'others than its owner may read' motion.csv --peer 1 --accuracy 0.3 --body body.ply --key other.key
refuse 2 'falls to zero within' motion.csv --peer 1 --body body.ply --max-force 500
refuse 2 '--max-energy and --any-energy exclude each other' motion.csv --peer 1 --body body.ply --max-energy 1 --any-energy
refuse 2 'a teleoperator needs --model' --listen 0 --body body.ply
refuse 2 'is no relaxation time' motion.csv --peer 1 --body body.ply --times -1
refuse 3 'z is' <(sed '5s/0.04,/x,/' motion.csv) --peer 1 --accuracy 0.3 --body body.ply
# Nobody there: no forces of zero that look like an answer.
refuse 5 '127.0.0.1:1: nothing answered' motion.csv --peer 1 --accuracy 0.3 --body body.ply --patience 0.3 -q -o nobody.csv
[[ ! -e nobody.csv ]] || complain 'forces that nobody answered are written'

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
