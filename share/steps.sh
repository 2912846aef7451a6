# Steps that run-example.sh and run-tests.sh share; sourced by them, in bash, from the top folder.

jobs=${HAPSIM_JOBS:-$(nproc 2>/dev/null || echo 2)}

# timed NAME COMMAND...: runs it and says how long it took.
timed() {
  local name=$1 start=$SECONDS
  shift
  printf '== %s\n' "$name"
  "$@"
  local status=$?  # reached with a failure only where the caller asks for it: timed ... || ...
  printf '== %s: %d s\n' "$name" $((SECONDS - start))
  return $status
}

# dependencies [--tests]: installs what is missing on Debian 12; elsewhere CMake, or the test that calls
# it, says what it does not find.
dependencies() {
  if (. /etc/os-release 2>/dev/null && [[ ${ID:-} == debian && ${VERSION_ID:-} == 12 ]]); then
    share/install-deps.sh "$@"
  else
    echo "not Debian 12: taking the dependencies for installed (see 'Other systems' in README.md)"
  fi
}

# build PRESET [TARGET...]: configures and builds it, or what is named of it, in build/PRESET.
build() {
  local preset=$1
  shift
  cmake --preset "$preset" --log-level=WARNING
  cmake --build --preset "$preset" --parallel "$jobs" ${1:+--target "$@"}
}

# The tools that the pipeline calls, one a line.
pipeline_tools() {
  make -nB --no-print-directory -f Makefile.pipeline BIN=bin OUT=build/example report |
    grep -oE '\bbin/hs-[a-z0-9]+' | sed 's|bin/||' | sort -u
}
