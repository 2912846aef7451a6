#!/usr/bin/env bash
# identify.sh BIN: what hs-identify refuses and how it says so; terms and windows.
set -uo pipefail
bin=$1
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-identify"
. "$(dirname "${BASH_SOURCE[0]}")/identify_data.sh"
common=(--body block.ply --rim-edge 0.3 --folds 0 -o out.csv)

expect 0 'viscoelastic tau1 = 0.' data.csv "${common[@]}" --add viscoelastic --terms auto:3
grep -q '1 term of viscoelastic chosen' .err || complain 'one term is chosen'
grep -q 'slower than 3 s is not identifiable' .err || complain 'what the holds do not tell is said'
expect 0 'viscoelastic tau1' data.csv "${common[@]}" --add viscoelastic --windows 0.1:1
grep -q '^viscoelastic,0,tau1,.*,0.1,1,free' out.csv || complain 'a window becomes bounds'
expect 2 'the windows of the relaxation times overlap' data.csv "${common[@]}" --add viscoelastic \
  --windows 0.1:1,0.5:3
expect 2 '--terms many is not a number of terms' data.csv "${common[@]}" --terms many
expect 2 '--windows 3 is no window' data.csv "${common[@]}" --windows 3

rm -f out.csv
awk '/^#/ || !n++ || n == 22' data.csv >one-row.csv # three components
expect 3 '3 force components cannot tell 4 free parameters' one-row.csv "${common[@]}" --noise 0.01 \
  --add sensor-rotation --fix nu
awk -F, -v OFS=, '/^[0-9]/ { $6 = $7 = $8 = 0 } 1' data.csv >still.csv
expect 3 'no row presses the body' still.csv "${common[@]}"
awk -F, -v OFS=, '/^[0-9]/ { $9 = -$9; $10 = -$10; $11 = -$11 } 1' data.csv >sign.csv
expect 3 'the forces point the wrong way' sign.csv "${common[@]}"
awk -F, -v OFS=, '/^[0-9]/ { $11 *= 1000 } 1' data.csv >milli.csv
expect 3 'column fz is some' milli.csv "${common[@]}"
sed '20s/,[^,]*$/,nan/' data.csv >nan.csv
expect 3 'nan.csv' nan.csv "${common[@]}"
awk -F, -v OFS=, '/^[0-9]/ { $5 = 0.09 } 1' data.csv >outside.csv
expect 3 'surface' outside.csv "${common[@]}"
awk -F, '/^[0-9]/ { if ($1 > 1) next } 1' data.csv >place.csv
expect 2 'too few contact positions' place.csv "${common[@]}" --add regions
[[ ! -e out.csv ]] || complain 'a refused run leaves nothing behind'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
