#!/bin/sh
# Our discrete step beside Yade's bonded concrete model and LAMMPS (peridynamics, granular contact) in
# the same run, on the same particles, one thread, processor time. Yade gets our bonds one by one, LAMMPS
# finds its own within a horizon of 1.2 d (random: 1.35 d). JSON lines, per bond and per particle:
# value = our rate, reference = theirs.
# usage: bench/peers.sh [--install] [directory of the programs]
set -eu
cd "$(dirname "$0")/.."

if [ "${1:-}" = --install ]; then
  shift
  as_root=""
  [ "$(id -u)" -eq 0 ] || as_root=sudo
  $as_root apt-get install -y -q --no-install-recommends yade lammps >&2
fi
programs=${1:-build/release/bin}
missing=""
command -v yade >/dev/null || missing="$missing yade"
command -v lmp >/dev/null || missing="$missing lammps"
[ -z "$missing" ] || echo "not measured:$missing; to install: apt-get install$missing (or $0 --install)" >&2
if [ ! -x "$programs/bench_peer_packing" ]; then
  echo "error: $programs/bench_peer_packing is missing: ninja -C build/release bench_peer_packing" >&2
  exit 4
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

# name of the peer, its particles, bonds and 1e6 particle-steps/s
print_lines() {
  awk -v name="$1" -v n="$2" -v bonds="$3" -v rate="$4" \
    -v our_n="$our_n" -v our_bonds="$our_bonds" -v our_rate="$our_rate" -v kind="$kind" '
    function line(what, ours, theirs, unit) {
      printf "{\"name\": \"%s, %d particles, per %s; reference: %s, %.2f bonds per particle\", \"value\": %.4g, \"unit\": \"1e6 %s/s\", \"reference\": %.4g, \"ratio\": %.3f}\n",
        kind, our_n, what, name, bonds / n, ours, unit, theirs, ours / theirs
    }
    BEGIN {
      line("bond", our_rate * our_bonds / our_n, rate * bonds / n, "bond-steps")
      line("particle", our_rate, rate, "particle-steps")
    }'
}

# atom style: a LAMMPS data file of the particles
write_data() {
  awk -v n="$our_n" -v d="$spacing" -v style="$1" '
    BEGIN {
      print "packing\n\n" n " atoms\n1 atom types\n"
      print "-1 1 xlo xhi\n-1 1 ylo yhi\n-1 1 zlo zhi\n\nAtoms # " style "\n"
    }
    { print NR, 1, style == "peri" ? d * d * d / sqrt(2) : 1.001 * d, 1, $1, $2, $3 }
  ' "$work/particles" >"$work/data.$1"
}

# name of the peer, input, variables
run_lammps() {
  name=$1 input=$2
  shift 2
  lmp -in "bench/peers/$input" -log none -var steps "$steps" "$@" >"$work/lammps" 2>&1 || {
    tail -n 3 "$work/lammps" >&2
    return 1
  }
  # The second run counts: wall time and the processor's share of it.
  result=$(awk '
    /^Loop time/ { seconds = $4; steps = $9; atoms = $12 }
    /CPU use/ { use = $1 / 100 }
    /^Total # of neighbors/ { pairs = $6 }
    END { print atoms, pairs, 1e-6 * atoms * steps / (seconds * use) }' "$work/lammps")
  # shellcheck disable=SC2086
  print_lines "$name" $result
}

for case in hexagonal:0.004 fcc:0.0285 random_2d:0.008 random_3d:0.05; do
  kind=${case%:*} spacing=${case#*:}
  result=$("$programs/bench_peer_packing" "$kind" "$spacing" "$work/particles" "$work/bonds")
  our_n=$(echo "$result" | cut -d' ' -f1)
  our_bonds=$(echo "$result" | cut -d' ' -f2)
  our_rate=$(echo "$result" | cut -d' ' -f3)
  steps=$((3000000 / our_n + 10))
  case $kind in random_*) reach=1.35 ;; *) reach=1.2 ;; esac
  if command -v yade >/dev/null; then
    result=$(yade -n -x -j1 bench/peers/yade_bonds.py "$work/particles" "$work/bonds" "$spacing" 2>"$work/yade" |
      sed -n 's/^result //p')
    # shellcheck disable=SC2086
    if [ -n "$result" ]; then print_lines "Yade, concrete model" $result; else cat "$work/yade" >&2; fi
  fi
  if command -v lmp >/dev/null; then
    write_data peri
    write_data sphere
    horizon=$(awk "BEGIN {print $reach * $spacing}")
    run_lammps "LAMMPS, peri/pmb" peridynamics.lmp -var pair peri/pmb -var file "$work/data.peri" -var horizon "$horizon"
    run_lammps "LAMMPS, peri/lps" peridynamics.lmp -var pair peri/lps -var file "$work/data.peri" -var horizon "$horizon"
    case $kind in random_*) ;; *) run_lammps "LAMMPS, gran/hooke/history" granular.lmp -var file "$work/data.sphere" ;; esac
  fi
done
