#!/usr/bin/env bash
# lumps.sh BIN OUT: the balls in a phantom of silicone (phantom_balls/whole_region_model_v2.csv, 589 sites), by all
# sites and by two halves of them (every other one), and where the sites themselves are stiffest. Sizes, depths and
# moduli are not documented: halves that contradict each other tell what intervals are worth. OUT keeps every step; what
# is there is not made again. Recordings: the folder realdata in $HAPSIM_SHARED.
# Recorded in bench/results/silicone-balls.txt (bench/record.sh).
set -euo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: lumps.sh BIN OUT" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export PATH="$(cd "$1" && pwd):$PATH"
. "$here/recordings.sh"
table=$(recordings phantom_balls/whole_region_model_v2.csv) || exit
mkdir -p "$2" && cd "$2"
[[ -e all.csv ]] || hs-import -q "$table" --unit mm --scan touched.csv -o all.csv
[[ -e body.ply ]] || hs-scan2ply -q touched.csv | hs-reconstruct -q --window | hs-tetmesh -q -o body.ply
for half in 0 1; do
  awk -F, -v half=$half '/^#/ || !n++ { print; next } $1 % 2 == half' all.csv >half$half.csv
done
for set in all half0 half1; do
  [[ -e $set.lumps.csv ]] || nice hs-identify -q $set.csv --body body.ply --effects elastic --fix nu=0.45 --folds 0 \
    --threads 1 -o $set.model.csv --lumps $set.lumps.csv
done
/usr/bin/python3 "$here/lumps.py" all half0 half1
