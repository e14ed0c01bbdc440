#!/usr/bin/env bash
# Times the grain solver against LIGGGHTS and LAMMPS (Debian 12) on the same bed, with the same contact
# law and step, turn by turn, and prints the medians and their ratios.
#
#   scripts/compare_peers.sh
#   CORES=1 REPEATS=3 GRAINS=20000 scripts/compare_peers.sh
#
# CORES (all), REPEATS (5), GRAINS (107687), STEPS (300) timed after WARMUP (300), SANDFLOW (the
# executable; built if not given), WORK (a folder to keep the files in; else they are removed).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cores=${CORES:-$(nproc)}
repeats=${REPEATS:-5}
grains=${GRAINS:-107687}
steps=${STEPS:-300}
warmup=${WARMUP:-300}
for number in "$cores" "$repeats" "$grains" "$steps" "$warmup"; do
    [[ $number =~ ^[0-9]+$ ]] || { echo "compare_peers.sh: $number is no number" >&2; exit 2; }
done

"$root/scripts/install_packages.sh" liggghts lammps openmpi-bin
if [ -z "${SANDFLOW:-}" ]; then
    "$root/scripts/build.sh" sandflow >/dev/null
    SANDFLOW=$root/build/sandflow
fi
if [ -n "${WORK:-}" ]; then
    mkdir -p "$WORK"
    work=$(cd "$WORK" && pwd)
else
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
fi

echo "making the bed of $grains grains"
"$SANDFLOW" bench kernel --grains "$grains" --write-positions "$work/bed.csv" \
    --steps 1 --warmup 0 --repeat 1 | sed -n 1p
# Both want: id type diameter density x y z, in a box that holds all grains.
awk -F, '
    NR == 1 { next }
    { row[NR] = sprintf("%d 1 0.01 2600 %s %s %s", $1, $2, $3, $4); if ($4 > top) top = $4; ++n }
    END {
        printf "bed at rest\n\n%d atoms\n2 atom types\n\n", n
        printf "0 0.6 xlo xhi\n0 0.6 ylo yhi\n0 %g zlo zhi\n\nAtoms\n\n", top + 0.2
        for (k = 2; k <= NR; ++k) print row[k]
    }' "$work/bed.csv" >"$work/bed.data"

# All print million particle-steps per second, neighbour lists included.
# time_peer PROGRAM DECK: output in $work/PROGRAM.out
time_peer()
{
    (cd "$work" && OMP_NUM_THREADS=1 mpirun --allow-run-as-root --bind-to none --oversubscribe \
        --mca mpi_yield_when_idle 1 -np "$cores" "$1" \
        -in "$root/tests/peers/$2" -log "$1.log" \
        -var bed bed.data -var warmup "$warmup" -var timed "$steps") >"$work/$1.out" 2>&1 || {
        echo "compare_peers.sh: $1 failed:" >&2
        tail -5 "$work/$1.out" >&2
        exit 4
    }
    # Loop time of T on P procs for S steps with N atoms
    awk '/^Loop time of/ { mps = 1e-6 * $9 * $12 / $4 } END { printf "%.3f\n", mps }' \
        "$work/$1.out"
}
time_sandflow()
{
    "$SANDFLOW" bench kernel --positions "$work/bed.csv" --threads "$cores" --steps "$steps" \
        --warmup "$warmup" --repeat 1 --json >"$work/sandflow.json"
    awk '/"mps":/ { gsub(/[^0-9.e+-]/, "", $2); printf "%.3f\n", $2 }' "$work/sandflow.json"
}
median()
{
    # Of an even number the mean of the middle two.
    sort -g | awk '{ v[NR] = $1 }
        END { printf "%.3f", (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'
}

echo "M particle-steps/s on $cores cores, $steps steps after $warmup:"
printf '%6s %10s %10s %10s\n' turn LIGGGHTS sandflow LAMMPS
for turn in $(seq "$repeats"); do
    a=$(time_peer liggghts settled_bed.liggghts)
    b=$(time_sandflow)
    c=$(time_peer lmp settled_bed.lammps)
    echo "$a" >>"$work/liggghts.mps"
    echo "$b" >>"$work/sandflow.mps"
    echo "$c" >>"$work/lammps.mps"
    printf '%6d %10s %10s %10s\n' "$turn" "$a" "$b" "$c"
done
a=$(tail -n "$repeats" "$work/liggghts.mps" | median)
b=$(tail -n "$repeats" "$work/sandflow.mps" | median)
c=$(tail -n "$repeats" "$work/lammps.mps" | median)
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.2f", b / a }'; }
printf '%6s %10s %10s %10s\n' median "$a" "$b" "$c"
echo "sandflow is $(ratio "$a" "$b") times as quick as LIGGGHTS, $(ratio "$c" "$b") times as LAMMPS"
# The same physics: the beds move alike.
energy_of()
{
    awk -v n="$(awk 'END { print NR - 1 }' "$work/bed.csv")" \
        '$2 == n && NF == 4 { e = $3 } END { printf "%.4g J", e }' "$work/$1.out"
}
echo "kinetic energy at the end: LIGGGHTS $(energy_of liggghts), LAMMPS $(energy_of lmp), sandflow" \
    "$(awk '/"kinetic_energy_j":/ { printf "%.4g J", $2 }' "$work/sandflow.json")"
version_of() { dpkg-query -W -f '${Version}' "$1"; }
echo "LIGGGHTS $(version_of liggghts), LAMMPS $(version_of lammps), Open MPI $(version_of openmpi-bin)"
echo "$("$SANDFLOW" --version); $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2-)"
