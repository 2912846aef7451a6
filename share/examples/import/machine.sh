#!/bin/sh
# machine.sh LxWxH RADIUS TABLE...: recordings of a testing machine on the middle of a block become data.csv and
# body.ply. Sizes with their unit: machine.sh 100x100x40mm 4mm meat_*.csv
set -eu
[ $# -ge 3 ] || { echo "usage: machine.sh LxWxH RADIUS TABLE..." >&2; exit 2; }
block=$1 radius=$2
shift 2
cat "$@" | hs-import --block "$block" --surface block.ply --tool-radius "$radius" -o data.csv
hs-tetmesh block.ply -o body.ply
