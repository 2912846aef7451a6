#!/usr/bin/env bash
# haptic_device.sh BIN: the example's header drives hs-simulate as a device would; killed at any
# moment, hs-simulate --live has lost nothing but the last line.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
example=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../share/examples/haptic-device" && pwd)

"$bin/hs-tetmesh" box.off --edge 0.02 -q -o body.ply || complain 'no body'
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.4,1\n' >model.csv
common=(--body body.ply --model model.csv --tool-radius 0.004)
"${CXX:-c++}" -std=c++17 -Wall -Wextra -Werror "$example/device_none.cpp" -o device 2>err || complain 'not compiled'
PATH=$bin:$PATH ./device 0.03 0.025 0.04 "${common[@]}" >out 2>err || complain 'the device failed'
grep -Eq '^largest force along z 0\.[1-9]' out || complain 'no force was felt'
PATH=$bin:$PATH ./device 0.03 0.025 0.04 --body none.ply --model model.csv --tool-radius 0.004 >out 2>err
(($? == 4)) || complain 'a stream that ended is not noticed'

# Killed in mid-stream: what was answered before is there, whole lines but perhaps the last.
mkfifo motion
"$bin/hs-simulate" --live "${common[@]}" -q <motion >forces.csv 2>err &
simulate=$!
exec {to}>motion
printf 't,x,y,z\n' >&"$to"
for i in {1..400}; do printf '0.%03d,0.03,0.025,0.039\n' "$i"; done >&"$to"
until_true 60 rows_in forces.csv 400
{ kill -KILL $simulate && wait $simulate; } 2>/dev/null
exec {to}>&-
[[ $(grep -Ec '^[0-9]+,0\.[0-9]+(,[^,]+){9},1,0$' forces.csv) == 400 ]] || complain 'lines were lost'

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
