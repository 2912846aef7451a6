#!/usr/bin/env bash
# meat.sh BIN OUT [--null] [TABLE...]: presses of meat by a testing machine, each table diagnosed alone: a row a table
# with the verdict, what it names (two names and a ?: cannot tell them apart), the error of the model with what is
# missing on the rest of the hold, learned until 4 s after the deepest point, the way out left off [% of the peak,
# median], that error without each companion (what is named beside relaxation and stiffening), and seconds; then the
# counts. A companion is false when its addition does not lower that error by 5 %. The block is as thick as the first
# `Ecartement entre outils`; its width and the tool are stated, for no table tells them.
# --null: the same courses pressed into an elastic block computed on a mesh of its own, of first-order elements, with
# noise of 0.3 to 3 % of the peak: nothing is to be named.
# OUT keeps each table's files; one that has its row is not run again.
# Recordings: the folder realdata in $HAPSIM_SHARED. Recorded in bench/results/meat.txt (bench/record.sh).
set -uo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: meat.sh BIN OUT [--null] [TABLE...]" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export PATH="$(cd "$1" && pwd):$PATH"
. "$here/recordings.sh"
folder=$(recordings meat_zwick) || exit
mkdir -p "$2" && out=$(cd "$2" && pwd)
shift 2
null=
[[ ${1-} == --null ]] && null=yes && shift
. "$here/recipes.sh"
if ((!$#)); then
  mapfile -t tables < <(cd "$folder" && printf '%s\n' meat_*.csv | sed 's/^meat_//; s/\.csv$//')
  [[ -n $null ]] && tables=("${tables[@]:0:40}")
  set -- "${tables[@]}"
fi

# The way in and the hold of data.csv; prints the time until which is learned.
hold() {
  awk -F, '/^#/ { print; next } !h { h = 1; print; next } { z = -$8; if (z > m) m = z }
    m > 5e-4 && z < 0.9 * m { exit } { print }' data.csv >hold.csv
  awk -F, '/^#/ { next } !h { h = 1; next } { t[++n] = $2; z[n] = -$8; if (z[n] > m) m = z[n] }
    END { for (i = 1; i <= n; ++i) if (z[i] >= 0.99 * m) { print t[i] - t[1] + 4; exit } }' hold.csv
}
# The forces of an elastic block instead; $1: a number for noise and seed.
pressed_elastic() {
  step 60 hs-tetmesh block.ply --order 1 --edge 5mm --contacts hold.csv -o other.ply &&
    printf 'effect,region,parameter,value,unit,std_error,lower,upper,state\nelastic,0,E,20000,Pa,,1,1e12,fixed\nelastic,0,nu,0.45,1,,0,0.499,fixed\n' >elastic.csv &&
    step 60 hs-simulate hold.csv --body other.ply --own-mesh --model elastic.csv -o exact.csv || return 1
  local noise
  noise=$(awk -F, -v k="$1" '/^#/ { next } !h { h = 1; next } $11 > m { m = $11 } END { print m * 0.003 * 10 ^ (k % 8 / 7) }' exact.csv)
  step 60 hs-simulate hold.csv --body other.ply --own-mesh --model elastic.csv --add-noise "$noise" --seed "$1" -o hold.csv.part &&
    mv hold.csv.part hold.csv
}
later() { # NAMES: median error [% of the peak] of the model with these effects on what comes later
  local effects=elastic terms name starts
  terms=$(printf '%s\n' "$@" | grep -c '^viscoelastic$')
  for name in $(printf '%s\n' "$@" | sort -u); do effects+=,$name; done
  for starts in 1 5; do
    step 120 hs-identify hold.csv --body body.ply --effects "$effects" --terms $((terms > 1 ? terms : 1)) --fix nu=0.45 \
      --starts $starts --until "$until" -o learned.csv || continue
    tr -s '\n ' '  ' <err | sed -n 's/.*not seen by the fit: .*median \([0-9.e-]*\) %.*/\1/p'
    return
  done
}
one() { # TABLE NUMBER
  local table thick
  table=$(ls "$folder"/meat_"$1"*.csv | sed -n 1p)
  thick=$(awk -F, '$1 == 0 { print $4; exit }' "$table")
  step 60 hs-import "$table" --block "100x100x${thick}mm" --tool-radius 4mm --surface block.ply -o data.csv || return 1
  until=$(hold)
  [[ -z $null ]] || pressed_elastic "$2" || return 1
  step 60 hs-tetmesh block.ply -o body.ply &&
    step 300 hs-identify hold.csv --body body.ply --effects elastic --fix nu=0.45 -o m0.csv &&
    step 600 hs-diagnose hold.csv --body body.ply --model m0.csv -o effects.csv
}
row() { # TABLE SECONDS CODE
  local missing rivals verdict companions='' error='' c rest false_ones=''
  missing=$(awk -F, '$3 == "missing" { printf "%s ", $2 }' effects.csv 2>/dev/null)
  rivals=$(awk -F, '$3 == "indistinguishable" { printf "%s ", $2 }' effects.csv 2>/dev/null)
  verdict=$(awk -F, '$2 == "model" { print $3 }' effects.csv 2>/dev/null)
  if [[ $3 == 0 && -z $null ]]; then
    # Of what cannot be told apart the first stands for all.
    # shellcheck disable=SC2086
    set -- "$1" "$2" "$3" $missing ${rivals%% *}
    error=$(later "${@:4}")
    for c in $(printf '%s\n' "${@:4}" | grep -v -e viscoelastic -e hyperelastic); do
      rest=$(later $(printf '%s\n' "${@:4}" | grep -v "^$c$"))
      companions+="without $c $rest "
      awk -v a="$error" -v b="$rest" 'BEGIN { exit !(a == "" || a > 0.95 * b) }' && false_ones+="$c "
    done
  fi
  [[ $3 == 0 ]] || companions=$(tail -n 1 err)
  printf '%-18s | %-12s | %-44s | %-22s | %6s | %-12s | %3d | %s\n' "$1" "$verdict" "$missing" "${rivals:+${rivals}?}" \
    "$error" "$false_ones" "$2" "$companions"
}

number=0
printf '%-18s | %-12s | %-44s | %-22s | %6s | %-12s | %3s | %s\n' table verdict missing "not told apart" 'rest %' false s remark
for table; do
  ((++number))
  if [[ ! -e $out/$table/row ]]; then
    rm -rf "${out:?}/$table" && mkdir -p "$out/$table" && cd "$out/$table" || exit 5
    began=$SECONDS
    one "$table" "$number" </dev/null
    code=$?
    row "$table" $((SECONDS - began)) $code >row.part && mv row.part row
  fi
  cat "$out/$table/row"
done
for table; do cat "$out/$table/row"; done | awk -F' *[|] ' '
  { ++n; named += $3 $4 != ""; relaxes += $3 $4 ~ /viscoelastic/; stiffens += $3 $4 ~ /hyperelastic/; wrong += $6 != ""
    missing_v += $3 ~ /viscoelastic/; missing_h += $3 ~ /hyperelastic/; if ($5 != "") e[++k] = $5 + 0 }
  END { printf "%d tables: %d name something, %d relaxation (%d alone), %d stiffening (%d alone), %d with a false companion",
      n, named, relaxes, missing_v, stiffens, missing_h, wrong
    for (i = 1; i <= k; ++i) for (j = i + 1; j <= k; ++j) if (e[j] < e[i]) { x = e[i]; e[i] = e[j]; e[j] = x }
    if (k) printf "; rest of the hold: median %.2f %%, worst %.2f %%", k % 2 ? e[(k + 1) / 2] : (e[k / 2] + e[k / 2 + 1]) / 2, e[k]
    print "" }'
