#!/usr/bin/env bash
# check-layers-test.sh: the layer check finds each kind of breach, and passes a clean tree.
set -euo pipefail
check=$(dirname "${BASH_SOURCE[0]}")/check-layers.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/lib/{base,io,cli,linalg,mesh,repair,solid} "$tree/tools"
layer() { # NAME USES...: one line in each list
  printf 'add_subdirectory(lib/%s)\n' "$1" >>"$tree/CMakeLists.txt"
  printf '| `%s` | a room |\n' "$1" >>"$tree/CONTRIBUTING.md"
  printf 'hapsim_layer(%s\n  SOURCES a.cpp%s\n  LINKS fmt::fmt)\n' "$1" "${2:+$'\n  USES '$2}" >"$tree/lib/$1/CMakeLists.txt"
}
layer base
layer io base
layer cli io
layer linalg base
layer mesh io
layer repair mesh
layer solid 'mesh linalg'

put() { printf '%s\n' "$2" >"$tree/$1"; }
expect() { # CODE TEXT
  local code=0 output
  output=$(bash "$check" "$tree") || code=$?
  [[ $code == "$1" && $output == *"$2"* ]] ||
    { printf 'expected exit %s and "%s", got exit %s and:\n%s\n' "$1" "$2" "$code" "$output"; exit 1; }
}

put lib/solid/a.cpp '#include "linalg/a.h"
#include "io/csv.h"'
put lib/repair/a.cpp '#include <CGAL/Surface_mesh.h>'
put lib/cli/a.cpp '#include <CLI/CLI.hpp>'
put tools/hs-a.cpp '#include "solid/a.h"'
expect 0 ""

put lib/io/b.h '  #  include "solid/a.h"'
expect 1 "lib/io/b.h:1: layer io must not include solid"
rm "$tree/lib/io/b.h"

put tools/hs-b.cpp '#include <tetgen.h>'
expect 1 "tools/hs-b.cpp:1: only lib/tetmesh may include"
rm "$tree/tools/hs-b.cpp"

put lib/solid/b.cpp '#include <suitesparse/cholmod.h>'
expect 1 "only lib/linalg may include"
rm "$tree/lib/solid/b.cpp"

put lib/cli/b.cpp '#include <CLI/App.hpp>'
expect 1 "CLI11 is included in more than one file"
rm "$tree/lib/cli/b.cpp"

mkdir "$tree/lib/odd"
expect 1 "layer 'odd' is not in CMakeLists.txt"
