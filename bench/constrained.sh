#!/usr/bin/env bash
# constrained.sh BUILD: hs-identify --constrain (the module of Python, which gives the tool's numbers) against SciPy's
# SLSQP on the same recording: 20 problems whose constraints bind, the largest relative difference of their parameters,
# and what processor time a fit takes with and without. Recorded in bench/results/constrained.txt (bench/record.sh). Ends with 1
# where a parameter differs by more than 1e-6 or a fit takes more than three times as much.
set -euo pipefail
build=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
awk 'BEGIN {
  print "OFF"; print 8, 12, 0
  for (i = 0; i < 8; ++i) print (i % 2) * 0.06, (int(i / 2) % 2) * 0.05, (i >= 4) * 0.04
  split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
  for (i = 1; i <= 12; ++i) print 3, f[i]
}' >box.off
"$build/bin/hs-tetmesh" -q box.off --edge 0.008 -o body.ply
export XDG_CACHE_HOME=$work/cache
PYTHONPATH=$build/python "${PYTHON:-/usr/bin/python3}" "$here/constrained.py"
