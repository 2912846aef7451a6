#!/usr/bin/env bash
# run.sh BIN OUT [NAME...]: every set of real recordings through import, body, first model, diagnosis, what is added
# and the error on what was not seen; prints a row a set. OUT keeps each set's files, words (log) and row; a set that
# has its row is not run again (delete OUT/NAME to do so). Recordings: the folder realdata in $HAPSIM_SHARED.
# Columns: presses; the verdict on the elastic model and what it names (a missing effect, or effects that cannot be
# told apart); errors on unseen positions, presses or the rest of them, of the elastic model and of the one that
# `--effects auto` ends with [N]; its effects; seconds by the clock.
# Recorded in bench/results/real.txt (bench/record.sh).
set -uo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: run.sh BIN OUT [NAME...]" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export PATH="$(cd "$1" && pwd):$PATH"
. "$here/recordings.sh"
folder=$(recordings .) || exit
mkdir -p "$2" && out=$(cd "$2" && pwd)
shift 2
. "$here/sets.sh"
. "$here/recipes.sh"

column() { # FILE ROW NAME: of a CSV without quotes before that column; ROW counts from 1, -1 is the last
  [[ -e $1 ]] && awk -F, -v row="$2" -v name="$3" '/^#/ { next } !h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; next }
    { v[++n] = $c[name] } END { print v[row < 0 ? n : row] }' "$1"
}
unseen() { # first or last: error of the models that were judged by what judged the last one
  [[ -e steps.csv ]] && awk -F, -v which="$1" '!h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; next }
    { e[++n] = $c["heldout"]; by[n] = $c["heldout_by"] }
    END { k = n; if (which == "first") while (k > 1 && by[k - 1] == by[n]) --k; if (n) printf "%.4g", e[k] }' steps.csv
}
named() { # what a diagnosis calls missing, and what it cannot tell apart
  [[ -e effects.csv ]] && awk -F, '$3 == "missing" { printf "%s ", $2 } $3 == "indistinguishable" { printf "%s? ", $2 }' effects.csv
}
row() { # NAME SECONDS CODE: the set's row, from what its recipe left
  local presses='' remark=ok
  [[ -e data.csv ]] && presses=$(awk -F, '/^#/ { next } !h { h = 1; next } !s[$1]++ { ++n } END { print n + 0 }' data.csv)
  (($3 == 0)) || remark=$(tail -n 1 err)
  printf '%-20s | %5s | %-12s | %-28s | %8s | %8s | %-34s | %4d | %s\n' "$1" "$presses" \
    "$(column effects.csv 1 verdict)" "$(named)" "$(unseen first)" "$(unseen last)" \
    "$(column steps.csv -1 effects)" "$2" "$remark"
}

printf '%-20s | %5s | %-12s | %-28s | %8s | %8s | %-34s | %4s | %s\n' set press verdict names before after effects s remark
failed=0
while IFS='|' read -r name recipe tables flags; do
  (($#)) && [[ " $* " != *" $name "* ]] && continue
  if [[ ! -e $out/$name/row ]]; then
    rm -rf "${out:?}/$name" && mkdir -p "$out/$name" && cd "$out/$name" || exit 5
    began=$SECONDS
    # shellcheck disable=SC2086
    "$recipe" "$flags" "$folder"/$tables </dev/null
    code=$?
    row "$name" $((SECONDS - began)) $code >row.part && mv row.part row
    echo "$code" >code
  fi
  cat "$out/$name/row"
  [[ $(cat "$out/$name/code") == 0 ]] || failed=1
done < <(sets)
exit "$failed"
