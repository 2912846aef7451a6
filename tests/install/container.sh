#!/usr/bin/env bash
# container.sh: the Dockerfile, where nothing can build it: every instruction is one that there is, in an order that
# works; what is copied from the sources is there and not ignored; commands parse, and name presets, scripts and
# packages that there are. BuildKit's own check runs where it is installed.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1
file=share/container/Dockerfile failures=0
complain() { printf 'FAILED: %s\n' "$*"; failures=$((failures + 1)); }
# Instructions in one line each, without comments.
lines=$(awk '/^[ \t]*(#|$)/ && !more { next } { more = sub(/\\$/, " "); printf "%s%s", $0, more ? "" : "\n" }' "$file")
[[ ${lines%%[[:space:]]*} == FROM ]] || complain 'it begins with FROM'
stages=' '
while read -r instruction rest; do
  case $instruction in
    FROM)
      read -r image as name <<<"$rest"
      [[ $image == debian:12 || $image == debian:12-slim ]] || complain "FROM $image: built and tried on Debian 12"
      [[ -z $as || (${as^^} == AS && -n $name) ]] || complain "FROM $rest"
      stages+="${name:--} "
      ;;
    COPY)
      read -r -a words <<<"$rest"
      ((${#words[@]} >= 2)) || complain "COPY $rest"
      if [[ ${words[0]} == --from=* ]]; then
        [[ $stages == *" ${words[0]#--from=} "* ]] || complain "COPY $rest: no such stage"
      else
        for source in "${words[@]:0:${#words[@]}-1}"; do
          [[ -e $source ]] || complain "COPY $source: is not in the sources"
          grep -qx "${source%%/*}" "$file.dockerignore" && complain "COPY $source: is ignored"
        done
      fi
      ;;
    RUN)
      sh -n -c "$rest" || complain "RUN $rest: does not parse"
      for preset in $(grep -o -- '--preset [a-z]*' <<<"$rest" | cut -d' ' -f2); do
        grep -q "\"name\": \"$preset\"" CMakePresets.json || complain "no preset $preset"
      done
      for script in $(grep -o 'share/[a-z-]*\.sh' <<<"$rest"); do
        [[ -x $script ]] || complain "$script cannot be run"
      done
      ;;
    USER | WORKDIR) [[ -n $rest ]] || complain "$instruction without a name" ;;
    CMD) python3 -c 'import json, sys; assert all(isinstance(w, str) for w in json.loads(sys.argv[1]))' "$rest" ||
      complain "CMD $rest: no list of words" ;;
    *) complain "no instruction: $instruction" ;;
  esac
done <<<"$lines"
# What CMake reads of the sources is not ignored.
while read -r ignored; do
  [[ $ignored == \#* ]] || ! grep -qE "^ *add_subdirectory\($ignored\)" CMakeLists.txt ||
    grep -B3 "add_subdirectory($ignored)" CMakeLists.txt | grep -q 'if(' || complain "$ignored is ignored, and built"
done <"$file.dockerignore"
for package in hapsim libhapsim0 python3-hapsim libhapsim-dev; do
  grep -q "PACKAGE_NAME $package)" cmake/HapsimPackage.cmake || complain "no package $package"
done
if docker buildx version >/dev/null 2>&1 && docker build --help 2>&1 | grep -q -- --check; then
  docker build --check -f "$file" . || complain 'docker build --check'
fi
((failures == 0))
