#!/usr/bin/env bash
# stream.sh BIN [MEGABYTES]: so much CSV through hs-simulate --live by a pipe; prints rate and peak memory,
# which must not grow with the length of the stream. Recorded in bench/results/stream.txt (bench/record.sh).
set -euo pipefail
bin=$(cd "$1" && pwd) size=${2:-2000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export XDG_CACHE_HOME=$work/cache
awk 'BEGIN { print "OFF"; print 8, 12, 0
  for (i = 0; i < 8; ++i) print (i % 2) * 0.06, (int(i / 2) % 2) * 0.05, (i >= 4) * 0.04
  split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
  for (i = 1; i <= 12; ++i) print 3, f[i] }' >box.off
"$bin/hs-tetmesh" -q box.off -o body.ply
printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\nviscoelastic,0,E1,4000\nviscoelastic,0,tau1,0.3\n' >model.csv
header='press,t,x,y,z,ux,uy,uz'
for press in 1 2; do
  awk -v p=$press 'BEGIN { for (i = 0; i < 20000; ++i) printf "%d,%.4f,%.3f,0.025,0.04,0,0,%.9f\n", p, i * 1e-3, 0.02 + 0.01 * p, -1e-7 * i }' >block$press
done
blocks=$((size * 1000000 / $(cat block1 block2 | wc -c) + 1))
stream() { printf '# tool_radius: 0.004\n%s\n' "$header"; for ((k = 0; k < $1; ++k)); do cat block1 block2; done; }
awk 'BEGIN { print "# tool_radius: 0.004\npress,x,y,z,ux,uy,uz"; for (p = 1; p < 3; ++p) print p "," 0.02 + 0.01 * p ",0.025,0.04,0,0,-0.001" }' >contacts.csv
for n in 1 "$blocks"; do
  start=$EPOCHREALTIME
  stream "$n" | /usr/bin/time -f %M -o memory "$bin/hs-simulate" -q - --live --body body.ply --model model.csv | wc -c >bytes
  awk -v n="$n" -v a="$start" -v b="$EPOCHREALTIME" -v mb="$(cat bytes)" -v kb="$(tail -n 1 memory)" \
    'BEGIN { printf "%d rows in %.1f s, %.0f MB of forces out, peak memory %.1f MB\n", n * 40000, b - a, mb / 1e6, kb / 1024 }'
done
