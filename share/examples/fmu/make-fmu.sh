#!/bin/sh
# make-fmu.sh OUT.fmu BODY MODEL TOOL_RADIUS [CONTACTS]: a body and a model of hapsim as an FMU of FMI 2.0 for
# co-simulation on 64-bit Linux. TOOL_RADIUS in metres. CONTACTS: a recording whose contact positions are solved finely.
# Needs a C compiler, libhapsim.so with hapsim.h, and python3 or zip. ACCURACY (0.02), CC, CFLAGS and LDFLAGS are taken
# from the environment. The FMU runs where libhapsim.so.0 is installed.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
fail() { echo "make-fmu.sh: $1" >&2; exit "${2:-2}"; }
[ $# -ge 4 ] && [ $# -le 5 ] || fail "usage: make-fmu.sh OUT.fmu BODY MODEL TOOL_RADIUS [CONTACTS]"
case $1 in *.fmu) ;; *) fail "$1 does not end in .fmu; name it so" ;; esac
name=$(basename "$1" .fmu | tr -c 'A-Za-z0-9_\n' _ | sed 's/^\([0-9]\)/_\1/')
folder=$(cd "$(dirname "$1")" 2>/dev/null && pwd) || fail "$1: there is no such folder; make it first" 5
out=$folder/$(basename "$1")
radius=$4
accuracy=${ACCURACY:-0.02}
number() { # WHAT VALUE LEAST MOST
  printf '%s' "$2" | awk -v least="$3" -v most="$4" '{ exit !(NR == 1 && /^([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?$/ && $1 >= least && $1 <= most) }' ||
    fail "$1: '$2' is no number from $3 to $4; write for example $5"
}
number TOOL_RADIUS "$radius" 1e-6 1 '0.004 (metres)'
number ACCURACY "$accuracy" 0.002 1 0.02
for file in "$2" "$3" ${5:+"$5"}; do [ -r "$file" ] && [ ! -d "$file" ] || fail "$file: cannot be read; is it there?" 5; done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/resources" "$work/binaries/linux64"
cp "$2" "$work/resources/body.ply" # formats are told apart by content
cp "$3" "$work/resources/model.csv"
[ $# -lt 5 ] || cp "$5" "$work/resources/contacts.csv"
# Says that library and description belong together: the same for the same contents.
guid=$({
  cat "$work"/resources/* "$here/hapsim_fmu.c" "$here/modelDescription.in.xml"
  echo "$name $radius $accuracy"
} | sha256sum | sed 's/^\(.\{8\}\)\(.\{4\}\)\(.\{4\}\)\(.\{4\}\)\(.\{12\}\).*/{\1-\2-\3-\4-\5}/')
version=$(hs-simulate --version | sed 's/[^0-9]*\([0-9][^ ]*\).*/\1/')
sed "s/@NAME@/$name/g; s/@GUID@/$guid/g; s/@VERSION@/$version/g; s/@RADIUS@/$radius/; s/@ACCURACY@/$accuracy/" \
  "$here/modelDescription.in.xml" >"$work/modelDescription.xml"
# shellcheck disable=SC2086  # flags are several words
"${CC:-cc}" -std=c99 -O2 -fPIC -fvisibility=hidden ${CFLAGS:-} -DHAPSIM_FMU_GUID="\"$guid\"" -DHAPSIM_FMU_RADIUS="$radius" \
  -DHAPSIM_FMU_ACCURACY="$accuracy" -I "$here" -shared "$here/hapsim_fmu.c" ${LDFLAGS:-} -lhapsim -lm \
  -o "$work/binaries/linux64/$name.so" || fail "it does not compile; are libhapsim.so and hapsim.h installed?" 5
cd "$work"
if command -v zip >/dev/null; then
  zip -qr packed.zip modelDescription.xml binaries resources
else
  python3 -m zipfile -c packed.zip modelDescription.xml binaries resources
fi
mv packed.zip "$out"
