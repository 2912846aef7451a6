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
  --loss 0.02 --idle 4 2>far.err &
far=$!
until_true 60 grep -qs listening far.err
port=$(sed -n 's/.*listening at 127.0.0.1:\([0-9]*\).*/\1/p' far.err)
[[ -n $port ]] || complain 'the teleoperator does not say where it listens'
for text in x HSL1 "$(printf 'HSL1%092d' 7)"; do printf '%s' "$text" >/dev/udp/127.0.0.1/"$port"; done
"$bin/hs-link" motion.csv --accuracy 0.3 --peer "$port" --body body.ply --delay 0.02 --jitter 0.005 --loss 0.02 \
  --samples 200 --identified identified.csv >felt.csv 2>err || complain 'the operator failed'
wait $far || complain 'the teleoperator failed'
[[ $(grep -c '^1,' felt.csv) == 1500 ]] || complain 'not every line was answered'
grep -q '2 foreign, 1 malformed, 1 peer' far.err || { complain 'strangers are not counted'; cat far.err; }
awk -F, '/^elastic,0,E,/ { exit !($4 > 19990 && $4 < 20010) }' identified.csv || complain 'E was not found'
awk -F, '/^#/ { next } !n++ { next } { f = $11; p = $16 } END { exit !(p == 1 && f > 0) }' felt.csv ||
  complain 'the identified body is not felt'

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-link" "$@" >/dev/null 2>err </dev/null
  got=$?
  ((got == code)) && grep -qF -- "$text" err && [[ $(wc -l <err) == 1 ]] ||
    complain "exit $got, not $code with '$text': $*"
}
refuse 2 'either a teleoperator or an operator' --body body.ply
refuse 2 "'host' is not an address" motion.csv --peer host --body body.ply
refuse 2 'a teleoperator needs --model' --listen 0 --body body.ply
refuse 2 'is no relaxation time' motion.csv --peer 1 --body body.ply --times -1
refuse 3 'z is' <(sed '5s/0.04,/x,/' motion.csv) --peer 1 --body body.ply
# Nobody there: no forces of zero that look like an answer.
refuse 5 '127.0.0.1:1: nothing answered' motion.csv --peer 1 --body body.ply -q -o nobody.csv
[[ ! -e nobody.csv ]] || complain 'forces that nobody answered are written'

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
