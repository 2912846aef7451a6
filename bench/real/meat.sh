#!/usr/bin/env bash
# meat.sh BIN OUT [TABLE...]: presses of meat by a testing machine, one a table, each diagnosed alone and improved by
# `--effects auto`; prints a row a table: the verdict, what it names missing, what it cannot tell apart, the error on
# the rest of the press of the elastic model and of the one with what is missing [N], and what `auto` ends with. The
# block is as thick as the first `Ecartement entre outils`; its width and the tool are stated, for no table tells them.
# Recordings: the folder realdata in $HAPSIM_SHARED.
set -uo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: meat.sh BIN OUT [TABLE...]" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export PATH="$(cd "$1" && pwd):$PATH"
mkdir -p "$2" && out=$(cd "$2" && pwd)
shift 2
folder=${HAPSIM_SHARED:-$here/../../../shared}/realdata/meat_zwick
[[ -d $folder ]] || { echo "meat.sh: no recordings: $folder is missing; set HAPSIM_SHARED" >&2; exit 3; }
. "$here/recipes.sh"
(($#)) || set -- 230331_FF1_1A 230331_FF2_1C 230331_RDG1_2B 230331_RDG2_1D 230403_FF1C 230403_RDG2C

one() { # TABLE
  local table=$folder/meat_$1_force.csv thick
  thick=$(awk -F, '$1 == 0 { print $4; exit }' "$table")
  step 60 hs-import "$table" --block "100x100x${thick}mm" --tool-radius 4mm --surface block.ply -o data.csv &&
    step 60 hs-tetmesh block.ply -o body.ply && fit_and_diagnose
}
named() { awk -F, -v verdict="$1" '$3 == verdict { printf "%s ", $2 }' effects.csv 2>/dev/null; }

failed=0
printf '%-16s | %-12s | %-32s | %-28s | %8s | %8s | %s\n' table verdict missing ambiguous before after auto
for table; do
  rm -rf "${out:?}/$table" && mkdir -p "$out/$table" && cd "$out/$table" || exit 5
  remark=''
  one "$table" </dev/null || { remark=$(tail -n 1 err); failed=1; }
  printf '%-16s | %-12s | %-32s | %-28s | %8s | %8s | %s\n' "$table" \
    "$(awk -F, '$2 == "model" { print $3 }' effects.csv 2>/dev/null)" "$(named missing)" "$(named indistinguishable)" \
    "$(awk -F, '$2 == "model" { print $6 }' effects.csv 2>/dev/null)" \
    "$(awk -F, '$2 == "model" { print $7 }' effects.csv 2>/dev/null)" \
    "${remark:-$(tail -n 1 steps.csv 2>/dev/null | cut -c1-60)}"
done
exit "$failed"
