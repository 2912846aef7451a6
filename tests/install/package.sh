#!/usr/bin/env bash
# package.sh BUILD: cpack makes the Debian packages, their dependencies are declared, and lintian finds
# no error in them. tests/fresh-debian.sh --package installs one on a fresh system.
set -euo pipefail
build=$1
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
fail() { echo "package: $*"; exit 1; }
for needed in dpkg-shlibdeps lintian; do
  command -v $needed >/dev/null || fail "$needed is not installed (share/install-deps.sh --tests)"
done
# xz is for what is released.
cpack --config "$build/CPackConfig.cmake" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip -B "$out" >"$out/log" 2>&1 ||
  { cat "$out/log"; fail "cpack"; }
packages=("$out"/*.deb)
names=$(for package in "${packages[@]}"; do dpkg-deb -f "$package" Package; done | LC_ALL=C sort | paste -sd' ')
wanted='hapsim libhapsim-dev libhapsim0'
[[ ! -d $build/python ]] || wanted+=' python3-hapsim'
[[ $names == "$wanted" ]] || fail "the packages are $names, not $wanted"
for package in "${packages[@]}"; do
  lintian --tag-display-limit 0 "$package" >"$out/tags" 2>"$out/log" || true
  ! grep '^E:' "$out/tags" || fail "lintian finds errors"
done
depends=$(dpkg-deb -f "$out"/hapsim_*.deb Depends)
for library in coinor-libipopt1v5 libcholmod3 libtet1.5 libopenblas0-pthread; do
  [[ $depends == *"$library"* ]] || fail "the package does not depend on $library"
done
[[ $(dpkg-deb -c "$out"/libhapsim0_*.deb) == *'/libhapsim.so.0 ->'* ]] || fail "libhapsim0 has no libhapsim.so.0"
echo "$(basename -a "${packages[@]}" | tr '\n' ' ')without errors"
