#!/bin/sh
# bag.sh [BAG [FOLDER]]: a bag of ROS 1 (press.bag) to a model, and the bag's poses through hs-simulate --live to
# forces.csv, as a node would have them. Needs hapsim's tools on the PATH; writes into FOLDER (here).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
bag=${1:-$here/press.bag}
out=${2:-.}
tool='--tool flat --tool-radius 4mm'

# What was pressed: here a block; yours is scanned.
awk -v what=cuboid -v a=0.06 -v b=0.05 -v c=0.04 -f "$here/../shapes.awk" |
  hs-tetmesh --edge 0.012 -q -o "$out/body.ply"
# shellcheck disable=SC2086  # the tool is several words
hs-import "$bag" $tool -o "$out/data.csv"
# One direction cannot tell Poisson's ratio, so it is held.
hs-identify "$out/data.csv" --body "$out/body.ply" --effects elastic,viscoelastic --fix nu=0.45 -o "$out/model.csv"
# Each pose is answered before the next is read. --contacts: where the bag presses is solved finely.
# shellcheck disable=SC2086
hs-import "$bag" --tip-motion $tool -q |
  hs-simulate --live --contacts "$out/data.csv" --body "$out/body.ply" --model "$out/model.csv" -o "$out/forces.csv"
