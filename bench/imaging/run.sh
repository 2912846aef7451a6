#!/usr/bin/env bash
# run.sh BIN OUT LENGTH SPREAD NUMBER...: bodies whose modulus is a random field (draw.py), pressed by hs-simulate on meshes
# of their own and recorded with noise; hs-identify --image on another mesh, and how often its 95 % hold the truth
# (score.py). OUT keeps everything; delete OUT/image-* to look again.
# Recorded in bench/results/imaging.txt (bench/record.sh).
set -euo pipefail
[[ -n ${5-} && -x $1/hs-identify ]] || { echo "usage: run.sh BIN OUT LENGTH SPREAD NUMBER..." >&2; exit 2; }
bin=$1 out=$2 length=$3 spread=$4
shift 4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
/usr/bin/python3 -c 'import numpy' || { echo "imaging: python3-numpy is missing" >&2; exit 5; }
export OPENBLAS_NUM_THREADS=1
mkdir -p "$out"
awk 'BEGIN { print "OFF\n8 12 0"; for (i = 0; i < 8; ++i) print (i % 2) * 0.08, (int(i / 2) % 2) * 0.08, (i >= 4) * 0.04
  split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
  for (i = 1; i <= 12; ++i) print 3, f[i] }' >"$out/block.off"
[[ -e $out/true.ply ]] || "$bin/hs-tetmesh" -q "$out/block.off" --edge 0.005 -o "$out/true.ply"
[[ -e $out/block.ply ]] || "$bin/hs-tetmesh" -q "$out/block.off" -o "$out/block.ply"
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"; for (p = 0; p < 25; ++p) for (i = 0; i <= 10; ++i)
  printf "%d,%.1f,%.3f,%.3f,0.04,0,0,%.6f\n", p, 0.1 * i, 0.016 + 0.012 * (p % 5), 0.016 + 0.012 * int(p / 5), -0.0002 * i }' >"$out/motion.csv"
for number; do
  if [[ ! -e $out/data-$number.csv ]]; then
    /usr/bin/python3 "$here/draw.py" "$out" "$number" "$length" "$spread"
    "$bin/hs-simulate" -q "$out/motion.csv" --body "$out/body-$number.ply" --model "$out/truth-$number.csv" --threads 1 \
      --seed "$number" --add-noise 0.001 -o "$out/data-$number.csv"
  fi
  [[ -e $out/image-$number.ply ]] || "$bin/hs-identify" -q "$out/data-$number.csv" --body "$out/block.ply" --effects elastic \
    --fix nu=0.45 --folds 0 --threads 1 -o "$out/model-$number.csv" --image "$out/image-$number.ply"
  PYTHONPATH=$here /usr/bin/python3 "$here/score.py" "$out" "$number" "$length" "$spread"
done
