#!/usr/bin/env bash
# Makes the five recordings of this folder anew. Needs hapsim's tools on the PATH; some minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The phantom's closed forms of shape and motion; every other sample. Forces come from the exact
# shape on second-order meshes twice as fine as any identification uses.
phantom=../phantom/geometry.awk
awk -v what=surface -f $phantom >"$work/surface.stl"
awk -v what=motion -f $phantom | awk '/^#/ || !header { header += !/^#/; print; next } ++n % 2' >"$work/motion.csv"
hs-tetmesh "$work/surface.stl" -o "$work/body.ply"

for name in a b c d e; do
  hs-simulate "$work/motion.csv" --body "$work/body.ply" --model "truth/$name.csv" --rim-edge 0.08 \
    --add-noise 0.010 --seed 7 |
    # In e the cables pick up a hum. Four digits after the point are a hundredth of the noise.
    awk -F, -v OFS=, -v hum=$([[ $name == e ]] && echo 0.05 || echo 0) '
      /^#/ { if ($0 !~ /^# simulated/) print; next }
      !header { header = 1; for (i = 1; i <= NF; ++i) at[$i] = i; print; next }
      {
        split("fx fy fz", axis, " ")
        for (k = 1; k <= 3; ++k)
          $at[axis[k]] = sprintf("%.4f", $at[axis[k]] + hum * sin(6.2832 * 1.37 * $at["t"] + k))
        print
      }' >"$work/$name.csv"
  mv "$work/$name.csv" "$name.csv"
done
