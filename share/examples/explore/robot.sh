#!/bin/sh
# robot.sh TRUTH MOTION: a simulated robot that executes a motion and prints its rows with forces, to be added to the
# recording; the header comes with the first ones. The folder TRUTH holds what nobody else may look at: body.ply and
# model.csv of the body as it is; done.csv, every motion so far, stays there, for what was pressed before may matter.
# NOISE [N] (0.01) of the force sensor, RIM of the meshes (finer than hapsim's own). Stands where your robot would.
set -eu
truth=$1 motion=$2
if [ -s "$truth/done.csv" ]; then first=0; else first=1; fi
[ $first = 0 ] || : >"$truth/done.csv"
{ cat "$truth/done.csv"; if [ $first = 1 ]; then cat "$motion"; else grep '^[0-9]' "$motion"; fi; } >"$truth/all.csv"
before=$(grep -c '^[0-9]' "$truth/done.csv" || true)
hs-simulate -q "$truth/all.csv" --body "$truth/body.ply" --model "$truth/model.csv" --rim-edge "${RIM:-0.1}" \
  --add-noise "${NOISE:-0.01}" --seed "${SEED:-11}" -o "$truth/forces.csv"
mv "$truth/all.csv" "$truth/done.csv"
awk -v first="$first" -v before="$before" '
  /^[0-9]/ { if (++row > before) print; next }
  !first { next }
  /^# (tool_radius|force_noise)/ || !/^#/' "$truth/forces.csv"
