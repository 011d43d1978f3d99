#!/usr/bin/env bash
# FE tests and one wheel curve on Debian's own DOLFINx, in a folder made by debootstrap; nothing is installed outside it.
#
#   tests/debian/run.sh [SUITE ...]      default: trixie (DOLFINx 0.9) and sid (0.11)
#
# Needs root (debootstrap, chroot and a private mount namespace) and the package debootstrap. Packages come from
# DEBIAN_MIRROR, by default the Debian mirror of this machine's own apt sources. REFERENCE is the curve they must equal
# to 1e-8; FE_TESTS the tests to run (default: every FE test); JOBS the number of processes.
set -euo pipefail
cd "$(dirname "$0")/../.."

target=test-debian
. tests/debian/system.sh
settings=(OMP_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  DOLFINX_ALLOW_USER_SITE_IMPORTS=1)

# Real arithmetic: python3-dolfinx alone could also be met by the complex build.
packages="python3-dolfinx-real python3-petsc4py-real python3-gmsh python3-numba python3-scipy
  python3-pydantic python3-pint python3-pytest python3-pytest-timeout python3-pytest-xdist python3-hypothesis gcc"
tests="${FE_TESTS:-tests/unit/test_fe_*.py tests/verification/test_fe_*.py}"
reference="${REFERENCE:-build/debian/wheel_build.csv}"
[ -f "$reference" ] || fail "$reference is not there; make test-debian computes it with the project's environment"

install() {
  local suite=$1 root=$2
  rm -rf "$root"; mkdir -p "$root"
  debootstrap --variant=minbase --include=ca-certificates "$suite" "$root" "$mirror"
  inside "$root" apt-get update --quiet
  inside "$root" apt-get install --quiet --yes --no-install-recommends $packages
  touch "$root/.installed"
}

for suite in "${@:-trixie sid}"; do
  for name in $suite; do
    root="$PWD/build/debian/$name"
    echo "== $name"
    [ -f "$root/.installed" ] || install "$name" "$root" > "build/debian/$name.log" 2>&1 ||
      fail "the packages of $name could not be installed; see build/debian/$name.log"
    rm -rf "$root/project"; mkdir "$root/project"
    git ls-files -z | tar --create --null --files-from=- | tar --extract --directory "$root/project"
    inside "$root" "cd /project && python3 tests/debian/wheel_curve.py /project/curve.csv"
    cp "$root/project/curve.csv" "build/debian/$name.csv"
    inside "$root" "cd /project && python3 tests/debian/compare_curves.py curve.csv -" < "$reference"
    inside "$root" "cd /project && python3 -m pytest -q -p no:cacheprovider -n ${JOBS:-2} --dist loadfile $tests"
  done
done
