#!/usr/bin/env bash
# sbom.sh BIN VERSION HEADERS...: a bill of materials of the tools in the folder BIN, CycloneDX 1.4 as JSON on
# standard output: every library that they load, by the file and, where dpkg knows it, the package that it came
# with, and the packages HEADERS, of which only headers or static libraries were compiled in. No times and
# no random numbers: the same build gives the same bytes.
set -euo pipefail
bin=$1 version=$2
shift 2

# text FIELD: as a JSON string
text() { printf '"%s"' "$(printf '%s' "$1" | tr -d '\000-\037' | sed 's/[\\"]/\\&/g')"; }
component() { # NAME VERSION PURL SCOPE
  printf '%s    {"type": "library", "name": %s, "version": %s, "purl": %s, "properties": [{"name": "hapsim:how", "value": %s}]}' \
    "$separator" "$(text "$1")" "$(text "$2")" "$(text "$3")" "$(text "$4")"
  separator=$',\n'
}
installed() { dpkg-query -W -f '${source:Package}\t${Version}\n' "$1" 2>/dev/null | head -n 1; }
distribution=$(. /etc/os-release 2>/dev/null && echo "${ID:-linux}-${VERSION_ID:-}" || echo linux)

printf '{\n  "bomFormat": "CycloneDX",\n  "specVersion": "1.4",\n  "version": 1,\n'
printf '  "metadata": {"component": {"type": "application", "name": "hapsim", "version": %s, "licenses": [{"license": {"id": "AGPL-3.0-or-later"}}]}},\n' "$(text "$version")"
printf '  "components": [\n'
separator=''
# Loaded libraries, each package once; one that no package knows by its file.
while IFS=$'\t' read -r name file; do
  package=$(dpkg-query -S "$(realpath "$file")" 2>/dev/null | head -n 1 | cut -d: -f1 || true)
  [[ -n $package ]] || package=$(dpkg-query -S "$file" 2>/dev/null | head -n 1 | cut -d: -f1 || true)
  printf '%s\t%s\n' "${package:-$name}" "${package:+yes}"
done < <(for tool in "$bin"/hs-*; do ldd "$tool" 2>/dev/null || true; done |
  awk '$2 == "=>" && $3 ~ /^\// { print $1 "\t" $3 }' | sort -u) | sort -u |
  {
    while IFS=$'\t' read -r package known; do
      source='' found=''
      [[ -z $known ]] || IFS=$'\t' read -r source found < <(installed "$package")
      component "$package" "$found" "${known:+pkg:deb/$distribution/$package@$found}" loaded
    done
    for package; do
      IFS=$'\t' read -r source found < <(installed "$package"; echo) || true
      component "$package" "$found" "pkg:deb/$distribution/$package@$found" 'compiled in'
    done
  } || exit 1
printf '\n  ]\n}\n'
