# Sourced by scratch.sh and tool.sh.
flat() { tr -s "\n " " " <"$1"; } # FILE: what is wrapped at 80 columns, in one line
need() { # PROGRAM...: what run-tests.sh installs; without it the test fails
  local program
  for program in "$@"; do
    command -v "$program" >/dev/null || { echo "FAILED: $program is not installed (share/install-deps.sh --tests)"; exit 1; }
  done
}
# until_true SECONDS COMMAND...: waits until the command succeeds; false when that takes longer
until_true() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS <= end)) || return 1
    sleep 0.02
  done
}
rows_in() { (($(grep -cs '^[0-9]' "$1") >= $2)); } # FILE COUNT
