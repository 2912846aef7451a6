#!/bin/sh
# organ.sh TABLE RADIUS [FLAGS of hs-import...]: an organ probed by a ball becomes data.csv and body.ply.
# RADIUS is the ball's, with its unit: 3mm.
set -eu
[ $# -ge 2 ] || { echo "usage: organ.sh TABLE RADIUS [FLAGS of hs-import]" >&2; exit 2; }
table=$1 radius=$2
shift 2
hs-import "$table" --tool sphere --tool-radius "$radius" "$@" --scan touched.csv -o data.csv
hs-scan2ply touched.csv | hs-reconstruct --window | hs-tetmesh -o body.ply
