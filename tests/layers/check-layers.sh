#!/usr/bin/env bash
# check-layers.sh ROOT: every include under ROOT/lib and ROOT/tools keeps to the layers.
# Prints one line a breach and exits 1 when there is any.
set -euo pipefail
root=$1
breaches=0

# layer: the layers directly below it. A layer may include itself and all that lies below.
table="
base:
io: base
cli: io
import: io
batch: io
linalg: base
estimate: linalg
geometry: io
scan: geometry
fem: geometry linalg
effects: fem
model: effects estimate
diagnose: model
realtime: model
report: io
"

# foreign header (extended regular expression): the one folder that may name it
foreign="
CGAL/: geometry
tetgen\.h: geometry
(suitesparse/)?cholmod\.h|Eigen/CholmodSupport: linalg
(coin/|coin-or/)?Ip[A-Z][A-Za-z]*\.hpp: estimate
kdl/|urdf_|console_bridge/|gdcm|nifti/|teem/: scan
CLI/: cli
sqlite3\.h: io
pugixml\.hpp: geometry
"

breach() { # FILE LINE TEXT
  printf '%s:%s: %s\n' "${1#"$root"/}" "$2" "$3"
  breaches=$((breaches + 1))
}

declare -A below
while IFS=: read -r layer lower; do
  [[ -n $layer ]] || continue
  allowed=" $layer "
  for name in $lower; do # the table lists lower layers first
    for deeper in ${below[$name]?"layer $name stands above $layer in the table"}; do
      [[ $allowed == *" $deeper "* ]] || allowed+="$deeper "
    done
  done
  below[$layer]=$allowed
done <<<"$table"

sources() { find "$@" -name '*.h' -o -name '*.cpp' | sort; }

for folder in "$root"/lib/*/; do
  layer=$(basename "$folder")
  [[ -n ${below[$layer]:-} ]] || { breach "$folder" 0 "layer '$layer' is not in the table"; continue; }
  for file in $(sources "$folder"); do
    while IFS=: read -r line used; do
      [[ -z $used || ${below[$layer]} == *" $used "* ]] ||
        breach "$file" "$line" "layer $layer must not include $used"
    done < <(sed -nE '/^[ \t]*#[ \t]*include[ \t]*"[a-z]+\//{=;s/.*"([a-z]+)\/.*/\1/p}' "$file" |
      paste -d: - -)
  done
done

while IFS= read -r rule; do
  [[ -n $rule ]] || continue
  pattern=${rule%: *}
  home=${rule##*: }
  while IFS=: read -r file line _; do
    [[ -z $file || $file == "$root/lib/$home/"* ]] ||
      breach "$file" "$line" "only lib/$home may include this foreign header"
  done < <(grep -rnE "^[ \t]*#[ \t]*include[ \t]*[<\"]($pattern)" --include='*.h' --include='*.cpp' \
    "$root/lib" "$root/tools" || true)
done <<<"$foreign"

cli11=$(grep -rlE '#include <CLI/' "$root/lib/cli" 2>/dev/null || true)
[[ $(wc -w <<<"$cli11") -le 1 ]] || breach "$root/lib/cli" 0 "CLI11 is included in more than one file"

((breaches == 0)) || { echo "$breaches breach(es) of the layers; the table stands in $0"; exit 1; }
