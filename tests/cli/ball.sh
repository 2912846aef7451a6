#!/usr/bin/env bash
# ball.sh BIN: a ball that the recording's header declares is used: Hertz's closed form (J. reine angew. Math. 92,
# 1882) on a block that is large beside the contact gives its modulus back.
set -uo pipefail
bin=$(cd "$1" && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-identify"
export XDG_CACHE_HOME=$work/cache
# E = 20 kPa, nu = 0.45, a ball of 4 mm; three presses 1.2 mm deep, noise of 1 mN.
awk 'BEGIN { srand(1); es = 20e3 / (1 - .45 ^ 2)
  print "# tool: sphere\n# tool_radius: 0.004\npress,x,y,z,ux,uy,uz,fx,fy,fz"
  for (p = 1; p <= 3; ++p) for (i = 0; i <= 24; ++i) { d = 5e-5 * i; e = -6
    for (k = 0; k < 12; ++k) e += rand()
    printf "%d,0,0,.06,0,0,%.9f,0,0,%.9f\n", p, -d, 4 / 3 * es * sqrt(.004) * d ^ 1.5 + .001 * e } }' >ball.csv
"$bin/hs-import" -q ball.csv --block 160x160x60mm --surface block.ply -o data.csv && "$bin/hs-tetmesh" -q block.ply -o body.ply ||
  complain 'the table is imported'
modulus() { awk -F, '$1 == "elastic" && $3 == "E" { print $4 }' "$1"; }
near() { awk -v a="$1" -v b="$2" -v share="$3" 'BEGIN { exit !(a > b * (1 - share) && a < b * (1 + share)) }'; }
expect 0 'tip kappa = 250 1/m is what the recording' data.csv --body body.ply --fix nu=0.45 -o ball.model
near "$(modulus ball.model)" 20000 .05 || complain "E = $(modulus ball.model) Pa, not 20 kPa"
# Without it the modulus takes it up, and a diagnosis of such a model says so.
sed 's/^# tool: sphere/# tool: flat/' data.csv >flat.csv
expect 0 'elastic E' flat.csv --body body.ply --fix nu=0.45 -o flat.model
near "$(modulus flat.model)" 20000 .3 && complain 'a flat tool gives another modulus'
"$bin/hs-diagnose" data.csv --body body.ply --model flat.model -o no.csv 2>.err
grep -q 'says tip kappa = 250 1/m, which the model lacks' .err || complain 'the model lacks the ball'
# What is asked for is fitted.
expect 0 'tip kappa = ' data.csv --body body.ply --fix nu=0.45 --effects elastic,tip -o free.model
grep -q '^tip,0,kappa,.*,free' free.model || complain 'a curvature that is asked for is fitted'
((failures == 0))
