#!/usr/bin/env bash
# identify.sh BIN: what hs-identify refuses and how it says so; terms and windows.
set -uo pipefail
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/tool.sh" "$1/hs-identify"
. "$here/identify_data.sh"
common=(--body block.ply --rim-edge 0.3 --folds 0 -o out.csv)

expect 0 ', tau1 = 0.' data.csv "${common[@]}" --add viscoelastic --terms auto:3
grep -q '1 term of viscoelastic chosen' .err || complain 'one term is chosen'
flat .err | grep -q 'slower than 3 s is not identifiable' || complain 'what the holds do not tell is said'
expect 0 'viscoelastic E1' data.csv "${common[@]}" --add viscoelastic --windows 0.1:1
grep -q '^viscoelastic,0,tau1,.*,0.1,1,free' out.csv || complain 'a window becomes bounds'
expect 2 'the windows of the relaxation times overlap' data.csv "${common[@]}" --add viscoelastic \
  --windows 0.1:1,0.5:3
expect 2 '--terms many is not a number of terms' data.csv "${common[@]}" --terms many
expect 2 '--windows 3 is no window' data.csv "${common[@]}" --windows 3

# What is held stays held while effects are added.
expect 0 'error' data.csv "${common[@]}" --effects auto --fix nu=0.45
grep -q '^elastic,0,nu,0.45,.*,fixed$' out.csv || complain '--effects auto with --fix'
expect 2 "the model has no parameter 'tau1'" data.csv "${common[@]}" --effects auto --fix tau1=3

# A long recording is fitted as means of neighbours, which is said; what is not long as it is.
expect 0 'data.csv: 244 rows are fitted as 124 means of 2, over 0.05 s each' data.csv "${common[@]}" --add viscoelastic \
  --noise 0.002 --most-rows 150
awk -F, '$3 == "E" { near += ($4 / 10000 - 1) ^ 2 < 0.05 ^ 2 } $3 == "tau1" { near += ($4 / 0.4 - 1) ^ 2 < 0.1 ^ 2 }
  /^# force_noise:/ { split($0, n, ": "); near += n[2] > 0.001 && n[2] < 0.0017 } END { exit near != 3 }' out.csv ||
  complain 'means of neighbours tell the material, and have less noise'
"$tool" -q data.csv "${common[@]}" --add viscoelastic && cp out.csv usual.csv
"$tool" -q data.csv "${common[@]}" --add viscoelastic --most-rows 0 && cmp usual.csv out.csv || complain 'few rows stay as they are'
expect 2 '--most-rows is -1; give a number from 0' data.csv "${common[@]}" --most-rows -1

# Two recordings of one body fitted together are the one that they were cut from.
awk -F, '/^[#p]/ || $1 < 2' data.csv >first.csv
awk -F, '/^[#p]/ || $1 >= 2' data.csv | sed 's/^2,/0,/; s/^3,/1,/' >second.csv
both=(--body block.ply --rim-edge 0.3 --folds 0 --noise 0.002 --add viscoelastic)
"$tool" -q data.csv "${both[@]}" -o whole.csv && "$tool" -q first.csv --data second.csv "${both[@]}" \
  -o joined.csv || complain 'recordings are fitted together'
paste -d, whole.csv joined.csv | awk -F, '/^(el|vis)/ { d = $4 / $13 - 1; if (d > 1e-6 || d < -1e-6) exit 1 }' ||
  complain 'two recordings give what the whole gives'
sed 's/tool_radius: 0.004/tool_radius: 0.004\n# recovery: full/' second.csv >other.csv
expect 3 'other.csv: another recovery than in first.csv' first.csv --data other.csv "${common[@]}"
awk -F, -v OFS=, '/^[0-9]/ && n++ == 30 { $3 += 0.01 } 1' second.csv >moving.csv
expect 3 'moving.csv:' first.csv --data moving.csv "${common[@]}"

# The beginning of each press predicts the rest, in noise; what cannot be cut is refused.
expect 0 'after 1.5 s, not seen by the fit: 120 samples, error 0.00' data.csv "${common[@]}" \
  --add viscoelastic --until 1.5
grep -q '^# heldout_later: 0.002' out.csv || complain 'the error on later rows is in the model'
expect 3 'data.csv: no press is longer than 5 s' data.csv "${common[@]}" --until 5
sed '1i # recovery: none' data.csv >goes-on.csv
expect 3 "goes-on.csv: it says 'recovery: none', so its presses cannot be cut" goes-on.csv "${common[@]}" --until 1

# What data lack is a matter of the data, not of the command.
cut -d, -f1,3- data.csv >still.csv
expect 3 'still.csv: the data cannot show viscoelastic; the recording has no column t' still.csv "${common[@]}" --add viscoelastic
expect 2 '--add is of recordings, and --follow reads a stream' data.csv --follow --body block.ply --add tip

# Another tool on the same body; the same recordings as of two bodies; what one body or one tool
# alone has is refused before anything is prepared.
awk -F, -v OFS=, '/tool_radius/ { $0 = "# tool_radius: 0.006" } 1' second.csv >wide.csv
two=(--rim-edge 0.3 --noise 0.002 -o out.csv)
expect 0 'presses at 2 positions by 2 tools' first.csv --data wide.csv --body block.ply "${two[@]}" --folds 2
flat .err | grep -q 'on positions not seen by the fit' || complain 'held out over all tools'
! grep -q '^# tool_radius' out.csv || complain 'a model of two tools names none'
expect 0 'presses at 2 positions by 2 tools' first.csv --body block.ply --data wide.csv \
  --body ./block.ply "${two[@]}" --folds 2
# Declared noise of several recordings: the root mean square of all rows.
for n in 1 7; do sed "1i # force_noise: 0.00$n" wide.csv >noisy$n.csv; done
expect 0 'noise 0.005 N (declared)' noisy1.csv --data noisy7.csv --body block.ply --rim-edge 0.3 -o noisy.csv --folds 0
cp block.ply other.ply
bodies=(first.csv --body block.ply --data second.csv --body other.ply "${two[@]}" --folds 0)
expect 0 'presses at 2 positions of 2 bodies' "${bodies[@]}" --add viscoelastic
paste -d, <(grep -v '^#' whole.csv) <(grep -v '^#' out.csv) | awk -F, '/^(el|vis)/ { d = $4 / $13 - 1; if (d > 1e-6 || d < -1e-6) exit 1 }' ||
  complain 'the same body under two names gives what one gives'
expect 2 'regions cannot be shared; its parameters belong to one body' "${bodies[@]}" --add regions
expect 2 'tip cannot be shared; its parameters belong to one tool' first.csv --data wide.csv \
  --body block.ply "${two[@]}" --add tip
for mode in '--effects auto' '--acfm 1' '--image i.vtu' '--lumps l.csv' '--refine-boundary 8' '--library lab.db'; do
  read -ra flags <<<"$mode"
  expect 2 'is for one body and one tool, and these recordings have several bodies' "${bodies[@]}" \
    "${flags[@]}"
done
expect 2 '--locations is for one body' "${bodies[@]}" --locations l.csv
expect 2 '2 bodies for 1 recording; give --body once, or once for each' first.csv --body block.ply \
  --body other.ply "${two[@]}"

rm -f out.csv
awk '/^#/ || !n++ || n == 22' data.csv >one-row.csv # three components
expect 3 '3 force components cannot tell 4 free parameters' one-row.csv "${common[@]}" --noise 0.01 \
  --add sensor-rotation --fix nu
awk -F, -v OFS=, '/^[0-9]/ { $6 = $7 = $8 = 0 } 1' data.csv >still.csv
awk -F, -v OFS=, '/^[0-9]/ { $9 = -$9; $10 = -$10; $11 = -$11 } 1' data.csv >sign.csv
awk -F, -v OFS=, '/^[0-9]/ { $11 *= 1000 } 1' data.csv >milli.csv
sed '20s/,[^,]*$/,nan/' data.csv >nan.csv
awk -F, -v OFS=, '/^[0-9]/ { $5 = 0.09 } 1' data.csv >outside.csv
awk -F, -v OFS=, '/^[0-9]/ { $9 = $10 = $11 = 0 } 1' data.csv >unmeasured.csv
wrong=(--body block.ply --rim-edge 0.3 -o out.csv)
for mode in '' '--add viscoelastic --terms auto' '--add regions' '--acfm 1' '--locations l.csv' \
  '--image i.csv' '--lumps lumps.csv' '--model whole.csv --refine-boundary 8' '--effects auto' '--library lab.db' \
  '--data first.csv'; do
  read -ra flags <<<"$mode"
  expect 3 'no row presses the body' still.csv "${wrong[@]}" "${flags[@]}"
  expect 3 'no row has a force' unmeasured.csv "${wrong[@]}" "${flags[@]}"
  expect 3 'the forces point the wrong way' sign.csv "${wrong[@]}" "${flags[@]}"
  expect 3 'column fz is some' milli.csv "${wrong[@]}" "${flags[@]}"
  expect 3 'nan.csv: a cell is not a finite number' nan.csv "${wrong[@]}" "${flags[@]}"
done
for mode in '' '--acfm 1' '--effects auto' '--locations l.csv'; do
  read -ra flags <<<"$mode"
  expect 3 'off the surface, more than 3 tool radii' outside.csv "${wrong[@]}" "${flags[@]}"
done
[[ ! -e l.csv && ! -e i.csv && ! -e lumps.csv && ! -e lab.db ]] || complain 'a refused run leaves nothing beside the model'
awk -F, '/^[0-9]/ { if ($1 > 1) next } 1' data.csv >place.csv
expect 0 'all presses are at one place' place.csv --body block.ply --rim-edge 0.3 --folds 0 -o placed.csv
expect 3 'too few contact positions' place.csv "${common[@]}" --add regions
expect 3 '--refine-boundary needs presses at four places or more' place.csv "${common[@]}" --model whole.csv \
  --refine-boundary 8
expect 3 '--image needs presses at four places or more' place.csv "${common[@]}" --image no.csv
expect 2 "--output and --lumps both write 'o.csv'; the second would replace the first" data.csv --body block.ply --lumps o.csv -o o.csv
expect 2 'both write' data.csv --body block.ply --lumps ./o.csv --locations o.csv -o m.csv
[[ ! -e o.csv && ! -e m.csv ]] || complain 'one file for two outputs, and something is left'
expect 3 '--lumps needs presses at four places or more' place.csv "${common[@]}" --lumps no.csv
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"; for (p = 0; p < 5; ++p) for (i = 1; i <= 2; ++i)
  printf "%d,%.2f,%.3f,0.03,0.03,0,0,%.6f\n", p, 0.05 * i, 0.018 + 0.006 * p, -0.0002 * i }' >few.csv
"$bin/hs-simulate" -q few.csv --body block.ply --model truth.csv --rim-edge 0.3 -o shallow.csv || complain 'no shallow presses'
expect 3 'an image needs 4: press deeper, or longer' shallow.csv "${common[@]}" --effects elastic --fix nu=0.4 --noise 0.028 --lumps no.csv
[[ ! -e out.csv ]] || complain 'a refused run leaves nothing behind'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
