#!/usr/bin/env bash
# silicone.sh BIN OUT: silicone cylinders between platens, three samples a recipe, fitted by elastic and hyperelastic
# together to a strain of 0.3; a row a recipe: E of all samples with its standard error, the published 6 C10 (Yeoh, two
# terms, of hyperelastic_parameters.json), and the largest difference of the model from the measured curves up to that
# strain [% of the force at 0.3]: of the model of all samples, then of each sample's own from its curve.
# Recordings: the folder realdata in $HAPSIM_SHARED. Recorded in bench/results/silicone.txt.
set -euo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: silicone.sh BIN OUT" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export PATH="$(cd "$1" && pwd):$PATH"
. "$here/recordings.sh"
folder=$(recordings silicone_compression) || exit
mkdir -p "$2" && cd "$2"
fitted() { # TABLE...: body, model and forces of these samples
  cat "$@" >tables.csv
  hs-import -q tables.csv --block 50x30mm --tool platen --surface block.ply -o data.csv
  hs-tetmesh -q block.ply -o body.ply
  hs-identify -q data.csv --body body.ply --effects elastic,hyperelastic --fix nu=0.45 -o model.csv
  hs-simulate -q data.csv --body body.ply --model model.csv -o forces.csv 2>/dev/null
}
largest_difference() {
  paste -d, <(grep '^[0-9]' data.csv | cut -d, -f1,8,11) <(grep '^[0-9]' forces.csv | cut -d, -f11) |
    awk -F, -v most=0.009 '$2 < 0 && -$2 <= most { if ($3 > peak[$1]) peak[$1] = $3; d = $4 - $3; if (d < 0) d = -d
      if (d > worst[$1]) worst[$1] = d }
      END { for (p in peak) if (worst[p] / peak[p] > w) w = worst[p] / peak[p]; printf "%.1f", 100 * w }'
}
printf '%-10s | %10s | %8s | %12s | %s\n' recipe 'E [Pa]' '+-' 'published' 'to 30 % strain: of all samples, each alone'
for recipe in $(cd "$folder" && printf '%s\n' *_A1.csv | sed 's/_A1\.csv$//'); do
  alone=''
  for table in "$folder/${recipe}"_A?.csv; do
    fitted "$table"
    alone+=" $(largest_difference) %"
  done
  fitted "$folder/${recipe}"_A?.csv
  published=$(awk -v recipe="\"$recipe\"" 'index($0, recipe) { own = 1 } own && /Yeoh_o2/ { yeoh = 1 }
    yeoh && /^ *-?[0-9.]+,?$/ { sub(/,/, ""); print 6000 * $1; exit }' "$folder/hyperelastic_parameters.json")
  awk -F, -v recipe="$recipe" -v published="$published" -v worst="$(largest_difference)" -v alone="$alone" '
    $1 == "elastic" && $3 == "E" {
      printf "%-10s | %10.0f | %8.0f | %12.0f | %s %%;%s\n", recipe, $4, $6, published, worst, alone }' model.csv
done
