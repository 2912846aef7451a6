#!/usr/bin/env bash
# check-headers-test.sh COMPILER [INCLUDE...]: the check finds what a header forgets to include, also where
# Eigen or a header of our own that many include is, and lends nothing to any.
set -euo pipefail
check=$(dirname "${BASH_SOURCE[0]}")/check-headers.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/lib/a" "$tree/lib/mesh"
put() { printf '%s\n' '#pragma once' "$2" >"$tree/lib/a/$1"; }
expect() { # CODE PATTERN
  local code=0 output
  output=$(bash "$check" "$tree" "${compiler[@]}" 2>&1) || code=$?
  [[ $code == "$1" && $output == *$2* ]] ||
    { printf 'expected exit %s and "%s", got exit %s and:\n%s\n' "$1" "$2" "$code" "$output"; exit 1; }
}
compiler=("$@") told=
put plain.h '#include <string>
std::string words();'
put vector.h '#include <Eigen/Core>
using Vec3 = Eigen::Vector3d;'
put both.h '#include "a/vector.h"
Vec3 both();'
put ../mesh/tetmesh.h '#include <string>
struct TetMesh { std::string name; };'
put body.h '#include "mesh/tetmesh.h"
TetMesh body();'
put through.h '#include "a/body.h"
TetMesh through();'
expect 0 '6 headers compile, each by itself'
put forgets.h '#include "a/vector.h"
std::map<int, Vec3> forgets();'
put lent.h 'Eigen::Vector3d lent();'
put order.h 'Vec3 order();'
put mesh_forgets.h '#include "a/body.h"
std::map<int, TetMesh> forgets();'
put mesh_lent.h 'TetMesh lent();'
for header in mesh_forgets forgets lent mesh_lent order; do told+="*a/$header.h does not compile by itself"; done
expect 1 "$told"
