#!/usr/bin/env bash
# check-install.sh BUILD: an installation under a prefix has every tool and man page, and they work
# from there.
set -euo pipefail
build=$1
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
fail() { echo "check-install: $*"; exit 1; }

cmake --install "$build" --prefix "$prefix" >"$prefix.log" 2>&1 || { cat "$prefix.log"; exit 1; }
rm -f "$prefix.log"
tools=("$build"/bin/hs-*)
[[ -e ${tools[0]} ]] || fail "no tool was built"
for tool in "${tools[@]}"; do
  name=$(basename "$tool")
  "$prefix/bin/$name" --version | grep -q "[0-9]" || fail "$name --version says no version"
  page=$prefix/share/man/man1/$name.1
  [[ -s $page ]] || fail "$name has no man page"
  grep -qi "^\.TH \"\?$name" "$page" || fail "$page has no title line"
  if command -v mandoc >/dev/null; then
    mandoc -T lint -W error "$page" || fail "mandoc finds errors in $name.1"
  fi
done
[[ -z $(find "$prefix" -type f ! -path '*/bin/hs-*' ! -path '*/share/*') ]] ||
  fail "something was installed outside bin and share"
echo "${#tools[@]} tools installed and asked"
