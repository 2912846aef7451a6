#!/usr/bin/env bash
# small.sh BIN OUT [SHAPE...]: forces above thin and small regions, balls and skins of 0.01 to 100 times the modulus around them
# beside CalculiX's on meshes that follow them (small.py, small_score.py), and what hs-simulate states of its error.
# OUT keeps the truths and nothing that is there is solved again. Recorded in bench/results/regions-small.txt.
set -euo pipefail
[[ -n ${2-} && -x $1/hs-simulate ]] || { echo "usage: small.sh BIN OUT [SHAPE...]" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for program in /usr/bin/python3 ccx gmsh; do
  command -v "$program" >/dev/null || { echo "small: $program is missing" >&2; exit 5; }
done
export PYTHONPATH=$here:$here/../independent
mkdir -p "$2"
/usr/bin/python3 "$here/small.py" "$2" "${@:3}" >&2
/usr/bin/python3 "$here/small_score.py" "$@"
