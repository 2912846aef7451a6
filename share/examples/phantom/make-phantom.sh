#!/usr/bin/env bash
# Makes the phantom's scan and recordings anew, beside this script. Needs hapsim's tools on the PATH.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

awk -v what=scan -f geometry.awk >scan.csv
awk -v what=motion -f geometry.awk >"$work/motion.csv"
awk -v what=surface -f geometry.awk >"$work/surface.stl"
hs-tetmesh "$work/surface.stl" -o "$work/body.ply"

# Four digits after the point are a hundredth of the noise.
for name in data plain; do
  hs-simulate "$work/motion.csv" --body "$work/body.ply" --model "truth-$name.csv" --rim-edge 0.08 \
    --add-noise 0.010 --seed 7 |
    awk -F, -v OFS=, '
      /^#/ { if ($0 !~ /^# simulated/) print; next }
      !header { header = 1; for (i = 1; i <= NF; ++i) if ($i ~ /^f[xyz]$/) force[i] = 1; print; next }
      { for (i in force) $i = sprintf("%.4f", $i); print }' >"$work/$name.csv"
  mv "$work/$name.csv" "$name.csv"
done
