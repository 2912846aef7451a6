#!/usr/bin/env bash
# library.sh BIN: hs-identify --library and hs-library.
set -uo pipefail
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/tool.sh" "$1/hs-identify"
. "$here/identify_data.sh"
common=(--body block.ply --rim-edge 0.3 --folds 0 --library lab.db)

expect 0 'lab.db: it has no entry yet' data.csv "${common[@]}" --material liver --object seven \
  --add viscoelastic -o m1.csv
expect 0 'lab.db: stored as entry 2' data.csv "${common[@]}" --material foam -o m2.csv
expect 0 'lab.db: start values from the nearest, entry 1 (liver, seven, flat tool of 4 mm, elements of' \
  data.csv "${common[@]}" --material liver --add viscoelastic -o m3.csv
cmp -s <(grep -v '^#' m1.csv | cut -d, -f1-3) <(grep -v '^#' m3.csv | cut -d, -f1-3) ||
  complain 'the same model is identified'
awk -F, 'NR == FNR { if (!/^[#e]f/) v[$1 $3] = $4; next } !/^#/ && $3 == "tau1" {
  d = $4 / v[$1 $3] - 1; exit !(d < 0.01 && d > -0.01) }' m1.csv m3.csv ||
  complain 'the same values are identified'
# The recording's own words
sed '1i # material: foam' data.csv >told.csv
expect 0 'start values from the nearest, entry 2 (foam' told.csv "${common[@]}" -o m4.csv
expect 0 'stored as entry 5' data.csv "${common[@]}" --model m1.csv -o m5.csv
! grep -q 'nearest' .err || complain 'with --model the library is only written'
expect 2 '--material describes an entry of a library' data.csv --body block.ply --material foam -o no.csv

# Bad libraries are told before anything is done, and leave no model behind.
cp data.csv text.db
expect 3 'text.db: this is no model library' data.csv "${common[@]/lab.db/text.db}" -o no.csv
mkdir folder.db
expect 5 'folder.db' data.csv "${common[@]/lab.db/folder.db}" -o no.csv
expect 5 'none/lab.db' data.csv "${common[@]/lab.db/none/lab.db}" -o no.csv
# A run that fails makes none.
sed 's/,0\.03,/,0.3,/' data.csv >off.csv
expect 3 'off the surface' off.csv "${common[@]/lab.db/new.db}" -o no.csv
[[ ! -e new.db ]] || complain 'a run that fails leaves an empty library'
# A model that cannot be written is not stored.
expect 5 'none/m.csv' data.csv "${common[@]}" -q -o none/m.csv
[[ ! -e no.csv ]] || complain 'a refused run leaves nothing behind'

tool=$bin/hs-library name=hs-library
"$tool" lab.db -o list.csv || complain 'the list'
[[ $(head -1 list.csv) == \
  entry,stored,material,object,element_size,tool,tool_radius,effects,E,nu,rmse,force_noise ]] ||
  complain 'columns of the list'
[[ $(tail -n +2 list.csv | cut -d, -f1,3,4,8) == $'1,liver,seven,elastic+viscoelastic
2,foam,,elastic
3,liver,,elastic+viscoelastic
4,foam,,elastic
5,,,elastic+viscoelastic' ]] || complain 'what the list holds'
[[ $("$tool" lab.db --material foam | tail -n +2 | cut -d, -f1 | tr '\n' ' ') == '2 4 ' ]] ||
  complain 'the list of one material'
"$tool" lab.db --show 1 -o shown.csv || complain 'an entry is shown'
cmp -s <(grep -v '^#' m1.csv) <(grep -v '^#' shown.csv) || complain 'the model as it was stored'
grep -q '^# material: liver' shown.csv || complain 'what it describes'
"$bin/hs-simulate" -q motion.csv --body block.ply --model shown.csv --rim-edge 0.3 -o forces.csv ||
  complain 'hs-simulate takes it'
expect 2 'lab.db has no entry 9' lab.db --remove 1,9
expect 0 '2 entries removed' lab.db --remove 1,2
[[ $("$tool" lab.db | tail -n +2 | cut -d, -f1 | tr '\n' ' ') == '3 4 5 ' ]] || complain 'what is left'
expect 2 'lab.db has no entry 1' lab.db --show 1
expect 2 'is not the number of an entry' lab.db --remove x
expect 2 'exclude each other' lab.db --remove 1 --show 1
expect 2 'a library is no stream' -
expect 5 'none.db: cannot be opened' none.db
expect 5 'none.db: cannot be opened' none.db --remove 1
[[ ! -e none.db ]] || complain 'asking makes no library'
expect 3 'text.db: this is no model library' text.db

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
