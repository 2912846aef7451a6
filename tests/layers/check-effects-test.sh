#!/usr/bin/env bash
# check-effects-test.sh: the check finds names and calls of effects, and lets comments, longer texts and
# lib/effects itself be.
set -euo pipefail
check=$(dirname "${BASH_SOURCE[0]}")/check-effects.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/lib/{effects,model,import} "$tree/tools"
put() { printf '%s\n' "$2" >"$tree/$1"; }
expect() { # CODE TEXT
  local code=0 output
  output=$(bash "$check" "$tree" 2>/dev/null) || code=$?
  [[ $code == "$1" && $output == *"$2"* ]] ||
    { printf 'expected exit %s and "%s", got exit %s and:\n%s\n' "$1" "$2" "$code" "$output"; exit 1; }
}
put lib/effects/sensor_gain.cpp '        .name = "sensor-gain",'
put lib/effects/tip.cpp '        .name = "tip",
  return name == "tip";'
put lib/model/a.cpp '// as "tip" does
const int tip = 1;  // tip_effect() is not called
x("tip of", "sensor-gains", other_tip_effect());'
put tools/hs-a.cpp 'spec.examples = {{"hs-a --add tip", "Adds \"tip\"."}};'
put lib/import/a.cpp 'column("tip");'
expect 0 ""
put lib/import/b.cpp 'column("tip", "sensor-gain");'
expect 1 'lib/import/b.cpp:1: column("tip", "sensor-gain");'
rm "$tree/lib/import/b.cpp"
put lib/model/b.h 'bool is(const std::string& n) { return n == "sensor-gain"; }'
expect 1 'lib/model/b.h:1: bool is('
rm "$tree/lib/model/b.h"
put tools/hs-b.cpp '
  use(sensor_gain_effect());'
expect 1 'tools/hs-b.cpp:2: use(sensor_gain_effect());'
rm "$tree/tools/hs-b.cpp"
expect 0 ""
rm "$tree"/lib/effects/*
expect 1 'has a .name'
