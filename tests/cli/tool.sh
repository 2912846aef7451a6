# Shared by the tests of single tools; sourced as `. tool.sh BIN/TOOL`. Goes to an empty folder of its
# own and counts in `failures`.
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
tool=$(realpath "$1")
name=${tool##*/}
work=$(mktemp -d)
trap '[[ $BASHPID != "$$" ]] || rm -rf "$work"' EXIT # not in a child that is killed early
cd "$work" || exit 1
failures=0

complain() { # TEXT
  printf 'FAILED: %s\n' "$1"
  [[ -s .err ]] && sed 's/^/    /' .err
  failures=$((failures + 1))
}
# expect CODE TEXT ARGUMENTS...: the exit code and a part of what goes to standard error, which is one
# line when the tool refuses its input or its use
expect() {
  local code=$1 text=$2
  shift 2
  "$tool" "$@" >.out 2>.err </dev/null
  local got=$?
  ((got == code)) || complain "exit code $got, not $code: $name $*"
  flat .err | grep -qF -- "$text" || complain "'$text' is not told by: $name $*"
  [[ $code != [235] ]] || [[ $(wc -l <.err) == 1 ]] || complain "not one line: $name $*"
}
