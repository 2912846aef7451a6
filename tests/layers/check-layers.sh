#!/usr/bin/env bash
# check-layers.sh ROOT: every include under ROOT/lib and ROOT/tools keeps to the layers.
# Prints one line a breach and exits 1 when there is any.
set -euo pipefail
root=$1
breaches=0

# layer: the layers directly below it, from the CMake lists, which name the lowest first. A layer may
# include itself and all that lies below.
table=$(for layer in $(sed -nE 's|^add_subdirectory\(lib/([a-z]+)\)|\1|p' "$root/CMakeLists.txt"); do
  printf '%s: ' "$layer"
  tr '\n' ' ' <"$root/lib/$layer/CMakeLists.txt" |
    sed -nE 's/.*hapsim_(layer|module)\(([^)]*)\).*/\2 LINKS/; s/.* USES ([^A-Z]*)[A-Z].*/\1/p' | tr -s ' '
  printf '\n'
done)

# foreign header (extended regular expression): the folders that may name it
foreign="
CGAL/: repair reconstruct tetmesh
tetgen\.h: tetmesh
(suitesparse/)?cholmod\.h|Eigen/CholmodSupport: linalg
(coin/|coin-or/)?Ip[A-Z][A-Za-z]*\.hpp: estimate
kdl/|urdf_|console_bridge/: robot
gdcm|nifti/|teem/: volume
CLI/: cli
boost/math/: estimate
sqlite3\.h: io
pugixml\.hpp: containers
matio\.h|hdf5\.h: tables
pybind11/: python
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
  [[ -n ${below[$layer]:-} ]] || { breach "$folder" 0 "layer '$layer' is not in CMakeLists.txt"; continue; }
  grep -q "^| \`$layer\` |" "$root/CONTRIBUTING.md" || breach "$folder" 0 "CONTRIBUTING.md does not say what lives there"
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
  homes=${rule##*: }
  while IFS=: read -r file line _; do
    folder=${file#"$root/lib/"}
    [[ -z $file || " $homes " == *" ${folder%%/*} "* ]] ||
      breach "$file" "$line" "only lib/${homes// /, lib/} may include this foreign header"
  done < <(grep -rnE "^[ \t]*#[ \t]*include[ \t]*[<\"]($pattern)" --include='*.h' --include='*.cpp' \
    "$root/lib" "$root/tools" || true)
done <<<"$foreign"

cli11=$(grep -rlE '#include <CLI/' "$root/lib/cli" 2>/dev/null || true)
[[ $(wc -w <<<"$cli11") -le 1 ]] || breach "$root/lib/cli" 0 "CLI11 is included in more than one file"

((breaches == 0)) || { echo "$breaches breach(es) of the layers; the CMake lists of lib say what may use what"; exit 1; }
