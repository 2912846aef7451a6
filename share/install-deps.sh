#!/usr/bin/env bash
# Installs what hapsim needs on Debian 12 to be built, to be tested, or to be worked on. Safe to run
# again: it does nothing, and needs no root, when everything is there.
#
#   share/install-deps.sh            compiler and libraries: what the tools are built from
#   share/install-deps.sh --python   also what the Python module is built from (-DHAPSIM_PYTHON=ON)
#   share/install-deps.sh --tests    also what run-tests.sh uses: other solvers, shells, browser, daemons
#   share/install-deps.sh --dev      also clang-tidy, ccache, and what fuzzing and benchmarks use
#   share/install-deps.sh --check    install nothing; exit 1 and say what is missing
#   share/install-deps.sh --anyway   on a relative of Debian 12, untested
set -euo pipefail

packages=(
  g++ make cmake ninja-build pkg-config git ca-certificates
  libeigen3-dev libboost-dev libcgal-dev libtbb-dev libtet1.5-dev libsuitesparse-dev libopenblas0-pthread
  coinor-libipopt-dev libcli11-dev libfmt-dev nlohmann-json3-dev libnanoflann-dev
  liborocos-kdl-dev liburdfdom-dev libgdcm-dev libnifti2-dev libteem-dev zlib1g-dev
  libsodium-dev libsqlite3-dev libpugixml-dev libmatio-dev libhdf5-dev
)
python_packages=(python3-dev pybind11-dev python3-numpy)
# Each is called by a test, or by run-tests.sh; none is asked for only where it happens to be installed.
test_packages=(
  libgtest-dev clang-format
  calculix-ccx gmsh tetgen libmujoco-dev           # peers: solver, meshers, a simulator that takes our forces
  chromium mandoc libxml2-utils sqlite3 python3 python3-jsonschema   # readers of what the tools write
  "${python_packages[@]}" python3-matplotlib
  zsh fish lintian                                # completions and packages
  slurm-wlm munge openssh-server openssh-client parallel
  strace procps bsdextrautils                     # faults at a chosen system call; pgrep; col
)
dev_packages=(clang-tidy clang libclang-rt-14-dev ccache debootstrap libbenchmark-dev python3-scipy
  python3-petsc4py)                               # peers of the solver: GAMG and hypre
# Daemons that come with them: the tests start their own, this machine need not serve anybody.
daemons=(openssh-server:ssh munge:munge slurm-wlm:slurmctld slurm-wlm:slurmd)

say() { printf 'install-deps: %s\n' "$*"; }
fail() { printf 'install-deps: %s\n' "$*" >&2; exit 1; }

check_only=no
anyway=no
for argument in "$@"; do
  case $argument in
    --python) packages+=("${python_packages[@]}") ;;
    --tests) packages+=("${test_packages[@]}") ;;
    --dev) packages+=("${test_packages[@]}" "${dev_packages[@]}") ;;
    --check) check_only=yes ;;
    --anyway) anyway=yes ;;
    -h | --help) sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) fail "unknown argument '$argument'; use --python, --tests, --dev, --check, --anyway or none" ;;
  esac
done

system=$(. /etc/os-release 2>/dev/null && printf '%s %s' "${ID:-unknown}" "${VERSION_ID:-}") || system=unknown
if [[ $system != "debian 12" ]]; then
  [[ $anyway == yes ]] && command -v apt-get >/dev/null ||
    fail "this is '$system', not Debian 12; see 'Other systems' in README.md for the package names," \
      "or try --anyway on a relative of Debian"
fi

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $state == installed ]] || missing+=("$package")
done

# The reference BLAS makes factorisation 2 to 6 times slower, so OpenBLAS must be the one in use.
slow_blas() {
  local name
  for name in libblas.so.3 liblapack.so.3; do
    name=$name-$(dpkg-architecture -qDEB_HOST_MULTIARCH 2>/dev/null || gcc -print-multiarch)
    [[ $(update-alternatives --query "$name" 2>/dev/null | sed -n 's/^Value: //p') == *openblas* ]] ||
      printf '%s\n' "$name"
  done
}

if [[ $check_only == yes ]]; then
  ((${#missing[@]} == 0)) || fail "missing: ${missing[*]}; run this again without --check"
  [[ -z $(slow_blas) ]] || fail "OpenBLAS is not the BLAS in use; run this again without --check"
  say "everything is installed"
  exit 0
fi

as_root=()
need_root() {
  [[ $(id -u) == 0 ]] && return
  command -v sudo >/dev/null || fail "root is needed and sudo is missing; run this script as root"
  as_root=(sudo)
}

# A daemon that comes with the tests' packages does not begin to serve, neither now (policy-rc.d) nor
# after a restart (masked: `systemctl unmask ssh` takes that back). One that was here is left alone.
quiet_daemons() {
  local daemon unit
  for daemon in "${daemons[@]}"; do
    unit=systemd/system/${daemon#*:}.service
    [[ " ${missing[*]} " == *" ${daemon%%:*} "* && ! -e /lib/$unit && ! -L /etc/$unit ]] || continue
    "${as_root[@]}" mkdir -p /etc/systemd/system
    "${as_root[@]}" ln -s /dev/null "/etc/$unit"
    [[ ! -e /usr/sbin/policy-rc.d ]] || continue
    printf '#!/bin/sh\nexit 101\n' | "${as_root[@]}" tee /usr/sbin/policy-rc.d >/dev/null
    "${as_root[@]}" chmod +x /usr/sbin/policy-rc.d
    policy=/usr/sbin/policy-rc.d
  done
}

if ((${#missing[@]})); then
  need_root
  say "installing ${missing[*]}"
  log=$(mktemp)
  policy=
  trap 'rm -f "$log"; [[ -z $policy ]] || "${as_root[@]}" rm -f "$policy"' EXIT
  quiet_daemons
  apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@"; }
  { apt update && apt install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 ||
    { tail -n 30 "$log" >&2; fail "apt-get failed; its last lines stand above"; }
  say "installed ${#missing[@]} packages"
fi

for name in $(slow_blas); do
  need_root
  choice=$(update-alternatives --list "$name" | awk '/openblas/ && !n++; END { exit !n }') ||
    fail "OpenBLAS offers no $name; is libopenblas0-pthread whole?"
  "${as_root[@]}" update-alternatives --set "$name" "$choice" >/dev/null
  say "$name is now OpenBLAS"
done
say "everything is installed"
