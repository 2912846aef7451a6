#!/usr/bin/env bash
# time.sh BIN OUT: what an image takes. A block of 80 x 80 x 40 mm with a stiff ball of 14 mm inside, its forces by hs-simulate
# on another mesh with noise, pressed at 10 x 10 places, imaged on a body of some 5,000 nodes whose contacts are prepared.
# Seconds by the clock and of the processor, memory, and the ball that was found.
# Recorded in bench/results/imaging-time.txt (bench/record.sh).
set -euo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: time.sh BIN OUT" >&2; exit 2; }
bin=$(cd "$1" && pwd)
shapes=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../share/examples" && pwd)/shapes.awk
mkdir -p "$2" && cd "$2"
export XDG_CACHE_HOME=$PWD/cache
awk -v what=cuboid -v a=0.08 -v b=0.08 -v c=0.04 -f "$shapes" >block.off
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"; for (p = 0; p < 100; ++p) for (i = 0; i <= 10; ++i)
  printf "%d,%.1f,%.4f,%.4f,0.04,0,0,%.6f\n", p, 0.1 * i, 0.0105 + 0.0065 * (p % 10), 0.0105 + 0.0065 * int(p / 10), -0.0002 * i }' >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,15000\nelastic,0,nu,0.42\n' >truth.csv
printf 'inclusion,0,%s\n' x,0.03 y,0.045 z,0.028 radius,0.007 ratio,5 >>truth.csv
[[ -s body.ply ]] || "$bin/hs-tetmesh" -q block.off --edge 0.0037 -o body.ply
[[ -s true.ply ]] || "$bin/hs-tetmesh" -q block.off --edge 0.004 -o true.ply
[[ -s data.csv ]] ||
  "$bin/hs-simulate" -q motion.csv --body true.ply --model truth.csv --rim-edge 0.25 --seed 2 --add-noise 0.005 -o data.csv
"$bin/hs-identify" -q data.csv --body body.ply --effects elastic --folds 0 -o model.csv
/usr/bin/time -o took -f '%e %U %S %M' "$bin/hs-identify" -q data.csv --body body.ply --effects elastic --folds 0 \
  -o model.csv --image image.ply --lumps lumps.csv
read -r clock user system memory <took
LC_ALL=C sed -n 's/^element vertex \([0-9]*\).*/\1/p' body.ply | awk -v c="$clock" -v u="$user" -v s="$system" -v m="$memory" \
  'NR == 1 { printf "100 presses, %d nodes: %.1f s by the clock, %.1f s of the processor, %.0f MB\n", $1, c, u + s, m / 1024 }'
grep -v '^#' lumps.csv
