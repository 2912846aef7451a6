#!/usr/bin/env bash
# link_day.sh BIN MINUTES: an operator and a teleoperator at 1 kHz over this machine's own network, in real time: a hand
# that presses a block once a second, a model that is identified while it runs. A row a minute: resident memory of the
# operator and the teleoperator [MB], lines that were answered so far, force at the deepest point of the last press [N].
# Then the growth of memory from the third minute to the last and of that force, its drift. Exit code 1 where memory
# grows by more than 1 MB or the force by more than 0.1 % (both after the third minute).
set -euo pipefail
[[ -n ${2-} && -x $1/hs-link ]] || { sed -n '2,6s/^# //p' "$0" >&2; exit 2; }
bin=$(cd "$1" && pwd) minutes=$2
work=$(mktemp -d)
cd "$work"
trap 'kill $(jobs -p) 2>/dev/null; wait; rm -rf "$work"' EXIT
awk 'BEGIN { n = split("0 0 0,60 0 0,60 50 0,0 50 0,0 0 40,60 0 40,60 50 40,0 50 40", p, ","); print "OFF\n8 12 0"
  for (i = 1; i <= n; ++i) { split(p[i], c, " "); print c[1] / 1e3, c[2] / 1e3, c[3] / 1e3 }
  print "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7" }' >box.off
"$bin/hs-tetmesh" box.off --edge 0.015 -q -o body.ply
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.45,1\n' >model.csv
"$bin/hs-link" --listen 0 --accuracy 0.3 --body body.ply --model model.csv --tool-radius 0.004 --delay 0.02 --loss 0.02 \
  --idle 60 2>far.err &
far=$!
until grep -qs listening far.err; do sleep 0.2; done
port=$(sed -n 's/.*listening at .*:\([0-9]*\)$/\1/p' far.err)
mkfifo motion
"$bin/hs-link" motion --peer "$port" --accuracy 0.3 --body body.ply --delay 0.02 --jitter 0.005 --loss 0.02 --samples 200 \
  2>near.err | awk -F, '/^#/ { next } !n++ { next } { ++lines; if ($11 > most) most = $11 }
    lines % 1000 == 0 { print lines, most >"felt.part"; close("felt.part"); most = 0 }' &
until near=$(pgrep -f "hs-link motion --peer $port"); do sleep 0.2; done
# Without an end: the lines are paced by the link itself.
awk 'BEGIN { print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  for (i = 0;; ++i) printf "1,%.3f,0.03,0.025,0.04,0,0,%.9g\n", i / 1000, -0.001 * (1 - cos(2 * 3.14159265358979 * (i % 1000) / 1000)) }' >motion &
resident() { awk '/VmRSS/ { printf "%.2f", $2 / 1024 }' "/proc/$1/status"; }
printf '%6s %9s %9s %9s %9s\n' minute 'near MB' 'far MB' answered 'most N'
: >rows
for ((m = 1; m <= minutes; ++m)); do
  sleep 60
  printf '%6d %9s %9s %9s %9s\n' "$m" "$(resident "$near")" "$(resident "$far")" $(cat felt.part) | tee -a rows
done
awk '$1 == 3 { a = $2; b = $3; f = $5 } { a1 = $2; b1 = $3; f1 = $5 }
  END { if (!f) exit 1; printf "from minute 3 on: near %+.2f MB, far %+.2f MB, force %+.4f %%\n", a1 - a, b1 - b, 100 * (f1 / f - 1)
    exit !(a1 - a <= 1 && b1 - b <= 1 && f1 / f - 1 < 1e-3 && f1 / f - 1 > -1e-3) }' rows
