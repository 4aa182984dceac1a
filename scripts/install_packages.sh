#!/bin/sh
# Installs the Debian packages that building Ligament needs, and further ones that are named; does
# nothing when all are there.
set -eu

packages="git ca-certificates g++ cmake ninja-build libdeal.ii-dev libtrilinos-amesos-dev
  libtrilinos-ml-dev libopenmpi-dev openmpi-bin libsuitesparse-dev libeigen3-dev nlohmann-json3-dev libcli11-dev libfmt-dev libhwy-dev zlib1g-dev libcairo2-dev
  fonts-dejavu-core libgtest-dev
  voro++-dev libboost-dev libassimp-dev $*"

if ! command -v apt-get >/dev/null 2>&1; then
  echo "error: apt-get not found. Ligament builds on Debian 12; elsewhere provide:" >&2
  echo "  g++ 12, cmake 3.22, ninja, git, deal.II 9.4 with Trilinos (Amesos, ML) and p4est, Open MPI 4.1 with mpirun, CHOLMOD 3, Eigen 3.4," >&2
  echo "  nlohmann-json 3.11, CLI11 2.1, fmt 9, Highway 1.0, zlib, Cairo 1.16 with a font, GoogleTest, Voro++ 0.4," >&2
  echo "  Boost (Graph, Geometry) 1.74, Assimp 5.2; for the tests the potential tables of lammps-data" >&2
  echo "  in /usr/share/lammps/potentials" >&2
  exit 4
fi

missing=""
for package in $packages; do
  case $(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true) in
    "install ok installed") ;;
    *) missing="$missing $package" ;;
  esac
done
if [ -z "$missing" ]; then
  echo "packages: all are there"
  exit 0
fi

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null 2>&1; then
    echo "error: to install packages, run as root or install sudo:$missing" >&2
    exit 4
  fi
  as_root="sudo"
fi

echo "packages to install:$missing"
$as_root apt-get update -q
# Answering "no" prints how much would be fetched and unpacked.
$as_root apt-get install --no-install-recommends --assume-no $missing |
  grep -E '^(Need to get|After this operation)' || true
case $missing in
  *libdeal.ii-dev*)
    free_mb=$(df -Pm /usr | awk "NR == 2 { print \$4 }")
    if [ "$free_mb" -lt 4000 ]; then
      echo "error: installing takes up to 4 GB below /usr, only $free_mb MB are free" >&2
      exit 4
    fi
    ;;
esac
$as_root env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -q --no-install-recommends -o DPkg::Lock::Timeout=300 $missing
