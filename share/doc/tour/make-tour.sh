#!/usr/bin/env bash
# make-tour.sh FOLDER: the tour's pictures from the shipped phantom, and what the tools said (said.txt). Needs
# hapsim's tools on the PATH and a browser (chromium).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[[ $# == 1 ]] || { echo "usage: make-tour.sh FOLDER" >&2; exit 2; }
mkdir -p "$1"
cd "$1"
pipeline=$here/../../../Makefile.pipeline
[[ -e $pipeline ]] || pipeline=$here/../../Makefile.pipeline # as it is installed
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  { echo "make-tour.sh: chromium is not installed" >&2; exit 2; }
picture() { # NAME PAGE WIDTH HEIGHT: NAME.png
  "$browser" --headless --no-sandbox --disable-gpu-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader \
    --hide-scrollbars --user-data-dir="$PWD/profile" --virtual-time-budget=5000 --window-size="$3,$4" \
    --screenshot="$PWD/$1.png" "file://$PWD/$2" >browser.log 2>&1 || { tail -n 3 browser.log >&2; exit 1; }
}

cp "$here/../../examples/phantom/scan.csv" "$here/../../examples/phantom/data.csv" .
make --no-print-directory -f "$pipeline" SCAN=scan.csv DATA=data.csv TITLE=phantom OUT=run report >recipe.txt 2>said.txt || { tail -n 5 said.txt >&2; exit 1; }

# Points and triangles seen from above the corner: what is nearer is drawn later.
project='function project(x, y, z) { px = 880 * (x - y) * 0.7071 / 0.15 + 450; py = 300 - 880 * (z * 0.85 - (x + y) * 0.7071 * 0.53) / 0.15; depth = x + y + z }'
page() { printf '<!DOCTYPE html><body style="margin:0"><svg xmlns="http://www.w3.org/2000/svg" width="900" height="520">'; sort -n | cut -d' ' -f2-; printf '</svg></body>'; }
awk -F, "$project"' NR > 1 && NF >= 3 { x = $1 / 1000; y = $2 / 1000; z = $3 / 1000
    if (z > -0.02 && z < 0.08) { project(x, y, z)
      printf "%.6f <circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.2\" fill=\"hsl(%d 60%% 42%%)\"/>\n", depth, px, py, 215 - 4500 * z } }' \
  scan.csv | page >scan.html
hs-tetmesh run/body.ply --ascii -q -o body.ply
awk "$project"' /^element vertex/ { n = $3 } /^end_header/ { on = 1; next } !on { next }
  count < n { X[count + 0] = $1; Y[count + 0] = $2; Z[count + 0] = $3; ++count; next }
  $1 == 3 && NF >= 4 { a = $2; b = $3; c = $4
    ux = X[b] - X[a]; uy = Y[b] - Y[a]; uz = Z[b] - Z[a]; vx = X[c] - X[a]; vy = Y[c] - Y[a]; vz = Z[c] - Z[a]
    nx = uy * vz - uz * vy; ny = uz * vx - ux * vz; nz = ux * vy - uy * vx; l = sqrt(nx * nx + ny * ny + nz * nz)
    if (nx + ny + nz <= 0) next # seen from behind
    light = 38 + 50 * (0.2 * nx + 0.35 * ny + 0.85 * nz) / l; points = ""; far = 0
    for (k = 2; k <= 4; ++k) { project(X[$k], Y[$k], Z[$k]); points = points sprintf("%.1f,%.1f ", px, py); far += depth / 3 }
    printf "%.6f <polygon points=\"%s\" fill=\"hsl(28 35%% %d%%)\" stroke=\"#6b5644\" stroke-width=\"0.5\"/>\n", far, points, light }' \
  body.ply | page >body.html
picture scan scan.html 900 520
picture body body.html 900 520

# The report of the first model alone, then that of the whole pipeline.
hs-compare data.csv --simulated first=run/f0.csv --body run/body.ply --model run/m0.csv --diagnosis first=run/effects0.csv \
  --title 'The first model: elastic' --html first.html -o residuals.csv 2>>said.txt
cp run/report.html after.html
picture first first.html 1280 800
picture after after.html 1280 800
rm -rf profile browser.log scan.html body.html body.ply residuals.csv scan.csv data.csv
