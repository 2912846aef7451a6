#!/usr/bin/env bash
# package-check.sh: on a system with the package hapsim installed: every tool's help, man page and
# completion are there, and the main job of the README runs from the installed tools; where python3-hapsim
# is installed too, the module finds what they find.
set -euo pipefail
fail() { echo "package-check: $*" >&2; exit 1; }
version=$(dpkg-query -W -f '${Version}' hapsim)
count=0
for tool in /usr/bin/hs /usr/bin/hs-*; do
  name=$(basename "$tool")
  count=$((count + 1))
  [[ $("$name" --help) == *"$name"* ]] || fail "$name --help"
  [[ $("$name" --version) == "$name (hapsim) ${version%-*}" ]] || fail "$name --version"
  # A minimal system excludes man pages when it unpacks; the package has them all the same.
  dpkg -L hapsim | grep "/man1/$name.1.gz$" >/dev/null || fail "$name has no man page"
  for file in bash-completion/completions/$name zsh/vendor-completions/_$name fish/vendor_completions.d/$name.fish; do
    [[ -s /usr/share/$file ]] || fail "/usr/share/$file is missing"
  done
done
[[ ! -e /usr/share/man/man1/hs-identify.1.gz ]] || man hs-identify >/dev/null || fail "man hs-identify"
out=$(mktemp -d)
make --no-print-directory -s -f /usr/share/hapsim/Makefile.pipeline OUT="$out" report 2>"$out/log" ||
  { tail "$out/log"; fail "the pipeline"; }
grep -q '</html>' "$out/report.html" || fail "there is no report"
grep -q '^1,viscoelastic,missing' "$out/effects0.csv" || fail "the hidden effect is not named"
printf 'name,scan,scan_unit,data\nphantom,%s/scan.csv,mm,%s/plain.csv\n' \
  /usr/share/hapsim/examples/phantom /usr/share/hapsim/examples/phantom >"$out/all.csv"
make --no-print-directory -s -f /usr/share/hapsim/Makefile.pipeline batch MANIFEST="$out/all.csv" OUT="$out/batch" ||
  fail "the batch"
if dpkg-query -W python3-hapsim >/dev/null 2>&1; then
  [[ -s $out/body.ply ]] || fail "the pipeline left no body"
  (cd "$out" && hs-identify -q /usr/share/hapsim/examples/phantom/data.csv --body body.ply --folds 0 -o tool.csv &&
    /usr/bin/python3 -c 'import hapsim
data = hapsim.Recording.read("/usr/share/hapsim/examples/phantom/data.csv")
hapsim.identify(data, hapsim.Body.read("body.ply"), folds=0).write("module.csv")' &&
    cmp tool.csv module.csv) || fail "the module of Python"
  echo "package-check: python3-hapsim $(dpkg-query -W -f '${Version}' python3-hapsim) gives the bytes of hs-identify"
fi
rm -rf "$out"
echo "package-check: $count tools of hapsim $version, the pipeline and a batch: passed"
