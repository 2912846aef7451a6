#!/usr/bin/env bash
# schemas.sh BIN: what each tool writes with --json is what its schema in share/schemas says, and nothing else.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
/usr/bin/python3 -c 'import jsonschema' || { echo 'schemas: python3-jsonschema is missing (share/install-deps.sh --tests)' >&2; exit 1; }

validated=
valid() { # TOOL FILE
  /usr/bin/python3 -W ignore -m jsonschema -i "$2" "$root/share/schemas/$1.schema.json" 2>err >err2 || {
    complain "$1: $2 is not what its schema says"
    cat err err2
  }
  validated+=" $1"
}
# A key that no schema knows, or one of another kind, must be found.
refused() { # TOOL FILE
  ! /usr/bin/python3 -W ignore -m jsonschema -i "$2" "$root/share/schemas/$1.schema.json" >/dev/null 2>&1 ||
    complain "$1: the schema takes $2"
}

phantom=$root/share/examples/phantom
"$bin/hs-scan2ply" -q "$phantom/scan.csv" --unit mm --json scan.json -o points.ply || exit 1
"$bin/hs-reconstruct" -q points.ply --json points.json -o surface.ply || exit 1
"$bin/hs-reconstruct" -q box.off --json mended.json -o mended.ply || exit 1
"$bin/hs-tetmesh" -q surface.ply --edge 8mm --json body.json -o body.ply || exit 1
"$bin/hs-tetmesh" -q box.off --order 1 --max-volume 2e-8 --json block.json -o block.ply || exit 1
valid hs-scan2ply scan.json
valid hs-reconstruct points.json
valid hs-reconstruct mended.json
valid hs-tetmesh body.json
valid hs-tetmesh block.json

# One that lacks something, one that lacks nothing, and too few presses for most questions.
box_presses 12 2e-4 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\n' >truth.csv
"$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --rim-edge 0.3 --add-noise 0.002 -o null.csv || exit 1
awk -F, -v OFS=, '/^#/ || !n++ { print; next } { $11 *= 1 + 200 * sqrt($8 * $8); print }' null.csv >stiff.csv
awk -F, '/^#/ || !n++ || $1 == 1' null.csv >one.csv
for data in null stiff one; do
  "$bin/hs-identify" -q $data.csv --body block.ply --rim-edge 0.3 --folds 0 -o model.csv || exit 1
  "$bin/hs-diagnose" -q $data.csv --body block.ply --model model.csv --rim-edge 0.3 --flips 99 --json $data.json -o effects.csv
  "$bin/hs-simulate" -q $data.csv --body block.ply --model model.csv --rim-edge 0.3 -o forces.csv || exit 1
  "$bin/hs-compare" -q $data.csv --simulated forces.csv --json compared-$data.json -o residuals.csv
  valid hs-diagnose $data.json
  valid hs-compare compared-$data.json
done
# Before the first press, and when no more are asked for.
"$bin/hs-plan" -q /dev/null --body block.ply --tool-radius 4mm --rim-edge 0.3 --json first.json -o first.csv || complain 'hs-plan without presses'
valid hs-plan first.json
"$bin/hs-plan" -q null.csv --body block.ply --rim-edge 0.3 --most-presses 1 --json last.json -o last.csv || complain 'hs-plan with presses enough'
valid hs-plan last.json
sed 's/"reached": false/"reached": "no"/' last.json >other.json && refused hs-plan other.json
sed 's/"nodes"/"knots"/' body.json >other.json && refused hs-tetmesh other.json
sed 's/"rows": [0-9]*/"rows": "many"/' compared-null.json >other.json && refused hs-compare other.json

for tool in "$bin"/hs-*; do
  name=$(basename "$tool")
  # screens.sh tries those without a schema of their own.
  [[ -e $root/share/schemas/$name.schema.json && " $validated " != *" $name "* ]] && complain "$name: its --json is not tested"
done
((failures == 0)) && echo 'schemas: passed'
exit $((failures > 0))
