#!/usr/bin/env bash
# check-install.sh BUILD: an installation under a prefix has every tool with its man page and completions,
# and they work from there; so does the library, by CMake and by pkg-config.
set -euo pipefail
build=$1
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
fail() { echo "check-install: $*"; exit 1; }
quietly() { "$@" >"$prefix/log" 2>&1 || { cat "$prefix/log"; fail "failed: $*"; }; }

for needed in mandoc zsh fish; do
  command -v $needed >/dev/null || fail "$needed is not installed (share/install-deps.sh --tests)"
done

quietly cmake --install "$build" --prefix "$prefix"
rm -f "$prefix/log"
tools=("$build"/bin/hs "$build"/bin/hs-*)
[[ -e ${tools[0]} && -e ${tools[1]} ]] || fail "no tool was built"
version=$(sed -n 's/^project(hapsim VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
for tool in "${tools[@]}"; do
  name=$(basename "$tool")
  [[ $("$prefix/bin/$name" --version) == "$name (hapsim) $version" ]] || fail "$name --version is not $version"
  page=$prefix/share/man/man1/$name.1
  [[ -s $page ]] || fail "$name has no man page"
  grep -qi "^\.TH \"\?$name.* \"hapsim $version\"" "$page" || fail "$page has no title line with the version"
  mandoc -T lint -W error "$page" || fail "mandoc finds errors in $name.1"
  # Every long flag of the man page is completed.
  flags=$(sed -n '/^.SH OPTIONS/,/^.SH/{/^\\fB/{s/\\-/-/g;s/.*\\fB\(--[a-z-]*\).*/\1/p}}' "$page" | sort -u)
  words=$(bash -c "source '$prefix/share/bash-completion/completions/$name'
    COMP_WORDS=($name --) COMP_CWORD=1; _${name//-/_}; printf '%s\n' \"\${COMPREPLY[@]}\"" | grep '^--' | sort -u)
  [[ -n $flags && $flags == "$words" ]] || fail "bash completes other flags of $name than it has"
  for shell in zsh:share/zsh/vendor-completions/_$name fish:share/fish/vendor_completions.d/$name.fish; do
    [[ -s $prefix/${shell#*:} ]] || fail "$name has no completion for ${shell%%:*}"
    "${shell%%:*}" -n "$prefix/${shell#*:}" || fail "${shell%%:*} does not read the completion of $name"
  done
done
[[ $(bash -c "source '$prefix/share/bash-completion/completions/hs-identify'
  COMP_WORDS=(hs-identify --robust t) COMP_CWORD=2; _hs_identify; echo \"\${COMPREPLY[*]}\"") == tukey ]] ||
  fail "bash does not complete a choice"
[[ -z $(find "$prefix" -type f ! -path '*/bin/hs' ! -path '*/bin/hs-*' ! -path '*/share/*' ! -path '*/include/hapsim/*' ! -path '*/include/hapsim.h' \
  ! -path '*/lib*/*') ]] || fail "something was installed outside bin, share, include and lib"
# Taken whole first: a grep that stops at its first match would end make by a closed pipe.
steps=$(make -n -f "$prefix/share/hapsim/Makefile.pipeline" OUT=out report)
[[ $steps == *"$prefix/share/hapsim/examples/phantom/scan.csv"* ]] ||
  fail "the installed pipeline does not find its phantom"

# The example program, by both ways, gives the force that the tool gives.
work=$prefix/work
mkdir "$work"
cp "$root"/share/examples/library/* "$work"
cd "$work"
printf 'OFF\n8 12 0\n0 0 0\n.06 0 0\n0 .05 0\n.06 .05 0\n0 0 .04\n.06 0 .04\n0 .05 .04\n.06 .05 .04\n%s\n' \
  '3 0 2 1
3 1 2 3
3 4 5 6
3 5 7 6
3 0 1 4
3 1 5 4
3 2 6 3
3 3 6 7
3 0 4 2
3 2 4 6
3 1 3 5
3 3 7 5' >box.off
"$prefix/bin/hs-tetmesh" -q box.off --max-volume 2e-8 -o body.ply
printf 'effect,region,parameter,value\nelastic,0,E,10000\nelastic,0,nu,0.4\n' >model.csv
printf '# tool_radius: 0.004\npress,x,y,z,ux,uy,uz\n1,0.03,0.025,0.04,0,0,-0.002\n' >motion.csv
export XDG_CACHE_HOME=$work/cache
force=$("$prefix/bin/hs-simulate" -q motion.csv --body body.ply --model model.csv | awk -F, 'END { printf "%.6f", $NF }')
flags=$(sed -n 's/^CMAKE_CXX_FLAGS:[A-Z]*=//p' "$build/CMakeCache.txt")  # a sanitizer's libraries want them
quietly cmake -S . -B build -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_FLAGS="$flags"
quietly cmake --build build
export PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name hapsim.pc)")
[[ $(pkg-config --modversion hapsim) == "$version" ]] || fail "pkg-config tells another version"
quietly sh -c "g++ $flags pressing.cpp \$(pkg-config --cflags --libs hapsim) -o pressing"
for program in build/pressing ./pressing; do
  last=$($program body.ply model.csv 0.03 0.025 0.04 0.004 0.002 | tail -n 1)
  [[ ${last##* } == "$force" ]] || fail "$program tells '$last', hs-simulate $force"
done
# The C interface, and the module over it.
printf '#include <hapsim.h>\n#include <stdio.h>\nint main(void) { return puts(hs_version()) < 0 || hs_interface() < HS_INTERFACE; }\n' >version.c
libraries=$(dirname "$(find "$prefix" -name libhapsim.so.0)")
quietly sh -c "cc $flags -I '$prefix/include' version.c -L '$libraries' -lhapsim -o version"
[[ $(LD_LIBRARY_PATH=$libraries ./version) == "$version" ]] || fail "a program of C does not run with libhapsim.so"
module=$prefix/lib/python3/dist-packages
[[ ! -d $module || $(LD_LIBRARY_PATH=$libraries PYTHONPATH=$module /usr/bin/python3 -c 'import hapsim; print(hapsim.__version__)') == "$version" ]] ||
  fail "the module of Python does not load"
code=0
./pressing body.ply nowhere.csv 0 0 0 1 1 2>err || code=$?
[[ $code == 5 ]] && grep -q "nowhere.csv: cannot be opened" err || fail "the library's error is not told"
echo "${#tools[@]} tools installed and asked; the library by CMake and pkg-config presses with $force N"
