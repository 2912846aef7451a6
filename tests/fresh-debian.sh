#!/usr/bin/env bash
# Tries the commands of README.md as a newcomer would: on a fresh, minimal Debian 12 made by
# debootstrap, from a clone of this repository's last commit. Needs root. Prints how long each took.
#
#   tests/fresh-debian.sh [--keep] [--package FILE.deb]... [FOLDER] [COMMAND...]
#
# With --package these Debian packages are installed and tried instead: nothing is cloned, and the COMMANDs,
# by default tests/package-check.sh, run in an empty folder.
# FOLDER (default: a new one under /tmp) receives the system and is removed unless --keep is given; an
# existing system in it is used again. COMMANDs default to ./run-example.sh and ./run-tests.sh.
# The mirror, proxies and certificates are taken from this machine's apt configuration.
set -euo pipefail

keep=no packages=()
while [[ ${1:-} == --* ]]; do
  case $1 in
    --keep) keep=yes ;;
    --package) packages+=("$(realpath "$2")"); shift ;;
    *) echo "fresh-debian: unknown flag $1" >&2; exit 2 ;;
  esac
  shift
done
root=${1:-$(mktemp -d /tmp/fresh-debian.XXXXXX)}
(($#)) && shift
commands=("$@")
if ((${#packages[@]} == 0)); then
  ((${#commands[@]})) || commands=(./run-example.sh ./run-tests.sh)
else
  ((${#commands[@]})) || commands=("bash /root/package-check.sh")
fi
repository=$(git -C "$(dirname "${BASH_SOURCE[0]}")" rev-parse --show-toplevel)

fail() { echo "fresh-debian: $*" >&2; exit 1; }
[[ $(id -u) == 0 ]] || fail "root is needed for debootstrap and chroot"
command -v debootstrap >/dev/null || fail "debootstrap is missing; run share/install-deps.sh --dev"

mounted=()
unmount() { local at; for at in "${mounted[@]}"; do umount -l "$at" || true; done; mounted=(); }
cleanup() {
  unmount
  # Never remove a tree in which something of this machine is still mounted.
  if grep -q " $root/" /proc/mounts; then echo "still mounted below $root: left in place" >&2; return; fi
  [[ $keep == yes ]] || rm -rf --one-file-system "$root"
}
trap cleanup EXIT

# This machine's Debian mirror: the first URI whose suites name bookworm.
mirror() {
  local from_sources from_lists
  from_sources=$(cat /etc/apt/sources.list.d/*.sources 2>/dev/null | awk '
    /^URIs:/ {uri = $2} /^Suites:/ && $2 == "bookworm" && uri && !n++ {print uri} /^$/ {uri = ""}')
  from_lists=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null |
    awk '/^deb / {sub(/^deb +(\[[^]]*\] +)?/, ""); if ($2 == "bookworm" && !n++) print $1}')
  printf '%s\n' "${from_sources:-${from_lists:-http://deb.debian.org/debian}}"
}

# copy PATH...: this machine's file or folder, links followed, to the same place in the new system.
copy() {
  local path
  for path in "$@"; do
    [[ -e $path ]] || continue
    mkdir -p "$root$(dirname "$path")"
    cp -rL "$path" "$root$(dirname "$path")/" 2>/dev/null || true
  done
}

start=$SECONDS
if [[ ! -e $root/etc/debian_version ]]; then
  eval "$(apt-config shell http_proxy Acquire::http::Proxy https_proxy Acquire::https::Proxy)"
  export http_proxy=${http_proxy:-} https_proxy=${https_proxy:-}
  [[ -n $http_proxy ]] || unset http_proxy
  [[ -n $https_proxy ]] || unset https_proxy
  debootstrap --variant=minbase bookworm "$root" "$(mirror)" >"$root.log" 2>&1 ||
    { tail -n 20 "$root.log" >&2; fail "debootstrap failed; its last lines stand above"; }
  rm -f "$root.log"
fi
copy /etc/resolv.conf /etc/hosts /etc/ssl/certs/ca-certificates.crt /usr/local/share/ca-certificates
for file in /etc/apt/apt.conf /etc/apt/apt.conf.d/* /etc/apt/auth.conf.d; do
  grep -rqsE 'Acquire|machine' "$file" && copy "$file"
done
echo "fresh-debian: system made in $((SECONDS - start)) s"

for at in proc sys dev; do
  mount --rbind "/$at" "$root/$at" 2>/dev/null && mount --make-rslave "$root/$at" &&
    mounted=("$root/$at" "${mounted[@]}") || echo "fresh-debian: cannot mount /$at; going on without"
done
rm -rf "$root/root/hapsim"
if ((${#packages[@]} == 0)); then
  git clone -q --no-hardlinks "$repository" "$root/root/hapsim"
else
  mkdir "$root/root/hapsim"
  rm -rf "$root/root/packages" && mkdir "$root/root/packages"
  cp "${packages[@]}" "$root/root/packages"
  cp "$repository/tests/package-check.sh" "$root/root/"
  commands=("apt-get -qq update && apt-get -qq -y install --no-install-recommends make man-db /root/packages/*.deb >/root/apt.log 2>&1 || { tail /root/apt.log; exit 1; }" "${commands[@]}")
fi

# Only what a login sets, and this machine's proxies.
environment=(HOME=/root DEBIAN_FRONTEND=noninteractive PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8)
for name in http_proxy https_proxy no_proxy; do
  [[ -n ${!name:-} ]] && environment+=("$name=${!name}")
done
result=0
for command in "${commands[@]}"; do
  start=$SECONDS
  code=0
  chroot "$root" env -i "${environment[@]}" bash -c "cd /root/hapsim && $command" || code=$?
  echo "fresh-debian: '$command' took $((SECONDS - start)) s, exit $code"
  ((code == 0)) || result=1
done
exit $result
