#!/bin/sh
# robot.sh [FOLDER]: plans a laser raster over the phantom, drives it on a simulated arm, and makes the
# body's surface of what the laser saw. Needs hapsim's tools on the PATH; writes into FOLDER (here).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-.}
# The same for planning and for reading: which robot, where the sensor sits on it, where the object lies.
setup="--robot $here/arm.urdf --tip-link sensor --mount 0.02,0,0.015 --object-frame 0.45,0.05,0.10,0,0,0.4"

awk -v what=surface -f "$here/../phantom/geometry.awk" >"$out/coarse.stl"
# shellcheck disable=SC2086  # the setup is several words
hs-scan2ply "$out/coarse.stl" $setup --scan-plan surface --pitch 0.004 --steepest 80 -o "$out/plan.csv"
awk -f "$here/laser.awk" "$out/plan.csv" >"$out/driven.csv"
# shellcheck disable=SC2086
hs-scan2ply "$out/driven.csv" $setup --range 0.02,0.3 -o "$out/points.ply"
hs-reconstruct "$out/points.ply" -o "$out/surface.ply"
