#!/usr/bin/env bash
# real_materials.sh BIN [FOLDER]: identification on recordings of real materials below FOLDER (otherwise
# $HAPSIM_SHARED/realdata); says what is not there.
#   meat:  tables of a testing machine (force, depth or travel, time) below a folder meat*: trained up to
#          4 s after the deepest point, with stiffening and two terms; asked: median error over the rest
#          at most 4 % of the peak, median over the tables.
#   cell:  tables cell*relax*, force or stress after a step: how many terms of three offered; asked: two.
#   liver: a recording of sites pig_liver*.csv: each position its own stiffness, interpolated between them,
#          alone and with laws of the depth; error on sites left out, asked: below 41.5 mN, the
#          inverse-distance map's.
# Recorded in bench/results/real-materials.txt (bench/record.sh).
# MEAT_BLOCK, MEAT_RADIUS, CELL_BLOCK, CELL_RADIUS, LIVER_RADIUS, IMPORT (further flags of hs-import): see
# below.
set -uo pipefail
[[ -n ${1-} && -x $1/hs-identify ]] || { echo "usage: real_materials.sh BIN [FOLDER]" >&2; exit 2; }
bin=$(cd "$1" && pwd) folder=${2:-${HAPSIM_SHARED:-.}/realdata}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
skip() { echo "SKIPPED: $1: none below $folder; give the folder or set HAPSIM_SHARED" >&2; }
# tables NAME...: files whose path holds one of the patterns
tables() {
  local pattern
  for pattern; do find "$folder" -type f -path "$pattern" 2>/dev/null; done | sort -u
}
# on_block TABLE BLOCK RADIUS: data.csv and body.ply in the work folder
on_block() {
  "$bin/hs-import" -q "$1" --block "$2" --surface "$work/block.ply" --tool-radius "$3" ${IMPORT-} \
    -o "$work/data.csv" && "$bin/hs-tetmesh" -q "$work/block.ply" -o "$work/body.ply"
}
# [s] from the first row of a press to its deepest point, the longest of all presses
ramp() {
  awk -F, '/^#/ { next } !h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; next }
    { p = $c["press"]; if (!(p in t0)) t0[p] = $c["t"]
      d = $c["ux"]^2 + $c["uy"]^2 + $c["uz"]^2
      if (d > 1.001 * deep[p]) { deep[p] = d; at[p] = $c["t"] - t0[p] } }
    END { for (p in at) if (at[p] > most) most = at[p]; print most + 0 }' "$work/data.csv"
}
median() { sort -g | awk '{ v[NR] = $1 } END { if (NR) print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'; }

mapfile -t meat < <(tables '*/meat*/*.csv' '*/meat*.csv')
if ((${#meat[@]} == 0)); then
  skip 'meat*/*.csv (relaxation of meat)'
else
  : >"$work/medians"
  for table in "${meat[@]}"; do
    name=$(basename "$table" .csv)
    if ! on_block "$table" "${MEAT_BLOCK:-100x100x40mm}" "${MEAT_RADIUS:-4mm}" 2>"$work/err"; then
      echo "meat $name: $(tail -1 "$work/err")"
      continue
    fi
    until=$(awk -v r="$(ramp)" 'BEGIN { print r + 4 }')
    if "$bin/hs-identify" "$work/data.csv" --body "$work/body.ply" --effects hyperelastic,viscoelastic \
      --fix nu=0.45 --terms 2 --folds 0 --until "$until" -o "$work/m.csv" 2>"$work/err"; then
      sed -n 's/.*not seen by the fit: .* median \([^ ]*\) % of the peak.*/\1/p' "$work/err" >"$work/median"
      cat "$work/median" >>"$work/medians"
      echo "meat $name: trained to $until s, later median error $(cat "$work/median") % of the peak"
    else
      echo "meat $name: $(tail -1 "$work/err")"
    fi
  done
  echo "meat: $(wc -l <"$work/medians") of ${#meat[@]} tables, median $(median <"$work/medians") % of the peak (asked 4)"
fi

mapfile -t cell < <(tables '*cell*relax*.csv' '*relax*cell*.csv')
((${#cell[@]})) || skip '*cell*relax*.csv (relaxation of cells)'
for table in "${cell[@]}"; do
  name=$(basename "$table" .csv)
  if on_block "$table" "${CELL_BLOCK:-100x100x40mm}" "${CELL_RADIUS:-4mm}" 2>"$work/err" &&
    "$bin/hs-identify" "$work/data.csv" --body "$work/body.ply" --effects viscoelastic --fix nu=0.45 \
      --terms auto:3 --folds 0 -o "$work/m.csv" 2>"$work/err"; then
    echo "cell $name: $(sed -n 's/^hs-identify: \(.* chosen.*\)/\1/p' "$work/err") (asked 2)"
  else
    echo "cell $name: $(tail -1 "$work/err")"
  fi
done

mapfile -t liver < <(tables '*pig_liver*.csv')
((${#liver[@]})) || skip '*pig_liver*.csv (sites on a pig liver)'
for table in "${liver[@]}"; do
  name=$(basename "$table" .csv)
  if "$bin/hs-import" -q "$table" --tool-radius "${LIVER_RADIUS:-4mm}" --scan "$work/scan.csv" ${IMPORT-} \
    -o "$work/data.csv" 2>"$work/err" &&
    "$bin/hs-reconstruct" -q "$work/scan.csv" -o "$work/surface.ply" 2>"$work/err" &&
    "$bin/hs-tetmesh" -q "$work/surface.ply" -o "$work/body.ply" 2>"$work/err"; then
    for effects in elastic hyperelastic tip; do
      if "$bin/hs-identify" "$work/data.csv" --body "$work/body.ply" --effects $effects --fix nu=0.45 \
        --add regions --regions sites --folds 1000 -o "$work/m.csv" 2>"$work/err"; then
        said=$(sed -n 's/^hs-identify: \(on positions not seen.*\)/\1/p' "$work/err")
      else
        said=$(tail -1 "$work/err")
      fi
      echo "liver $name, $effects: $said (asked 0.0415 N)"
    done
  else
    echo "liver $name: $(tail -1 "$work/err")"
  fi
done
