#!/usr/bin/env bash
# From a fresh checkout to a report: installs what is missing, builds the tools it needs, runs the whole
# pipeline on the phantom that is shipped in share/examples.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. share/steps.sh

out=build/example
timed "dependencies" dependencies
# The tools that the pipeline calls; `cmake --build --preset release` builds the others.
mapfile -t tools < <(pipeline_tools)
timed "build" build release "${tools[@]}"
export PATH="$PWD/build/release/bin:$PATH"
timed "pipeline" make --no-print-directory -f Makefile.pipeline SHELL="$PWD/share/timed-shell" \
  BIN="$PWD/build/release/bin" OUT="$out" report
echo "done in $SECONDS s; the report: $PWD/$out/report.html"
