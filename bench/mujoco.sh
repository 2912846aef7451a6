#!/usr/bin/env bash
# mujoco.sh BUILD: what the contact forces of 4,096 simulations of MuJoCo (libmujoco-dev 2.2.2) cost a step, on one
# processor: a body with two Maxwell terms by the callback of share/examples/mujoco (asked: 8 ms), an elastic one all
# at once (asked of hapsim's part: 3 ms; the rest is MuJoCo's, which turns forces into those of joints). mujoco.c says
# what is timed. Recorded in bench/results/mujoco.txt (bench/record.sh). Ends
# with 1 where a median is above what is asked.
set -euo pipefail
[[ -n ${1-} && -x $1/bin/hs-tetmesh ]] || { echo "usage: mujoco.sh BUILD" >&2; exit 2; }
build=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
example=$root/share/examples/mujoco
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
[[ -e /usr/include/mujoco/mujoco.h ]] || { echo 'mujoco.sh: MuJoCo is not installed (apt-get install libmujoco-dev)' >&2; exit 5; }
cc -O2 -std=c99 -Wall -Wextra -I "$example" -I "$root/lib/c" "$root/bench/mujoco.c" -L "$build/lib" -lhapsim -lmujoco -lm \
  -Wl,-rpath,"$build/lib" -o mujoco
awk -v what=cuboid -v a=0.12 -v b=0.09 -v c=0.06 -f "$root/share/examples/shapes.awk" >block.off
"$build/bin/hs-tetmesh" -q block.off -o body.ply
printf 'effect,region,parameter,value\nelastic,0,E,15000\nelastic,0,nu,0.45\n' >elastic.csv
{ cat elastic.csv; printf 'viscoelastic,0,E1,6000\nviscoelastic,0,tau1,0.1\nviscoelastic,0,E2,3000\nviscoelastic,0,tau2,1\n'; } >viscoelastic.csv
export XDG_CACHE_HOME=$work/cache OMP_NUM_THREADS=1
run() { taskset -c 0 ./mujoco "$example/press.xml" body.ply "$@"; }
{ run viscoelastic.csv callback; run elastic.csv callback; run viscoelastic.csv batch; run elastic.csv batch; } | tee lines
awk '{ ms[NR] = $0; sub(NR == 4 ? /.*part / : /.*of 4096: /, "", ms[NR]) }
  END { if (NR != 4 || ms[1] + 0 > 8 || ms[2] + 0 > 8 || ms[4] + 0 > 3) { print "not as asked"; exit 1 } }' lines
