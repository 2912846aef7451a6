#!/usr/bin/env bash
# module.sh BIN MODULE PYTHON: what the module does that the C interface does not: arrays, errors, keywords, signals.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
module=$(realpath "$2") python=$3
. "$root/tests/cli/scratch.sh" "$1"
"$bin/hs-tetmesh" box.off --edge 0.012 -q -o body.ply || complain 'no body'
box_presses 24 0.0001 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,12000\nelastic,0,nu,0.4\nviscoelastic,0,E1,6000\nviscoelastic,0,tau1,0.3\n' >hidden.csv
"$bin/hs-simulate" motion.csv --body body.ply --model hidden.csv --add-noise 0.002 -q -o data.csv || complain 'no data'
PYTHONPATH=$module PATH=$bin:$PATH "$python" "$root/tests/python/module_test.py" >out 2>err || complain "$(cat out)"
((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
tail -n 1 err
