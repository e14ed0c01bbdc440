#!/usr/bin/env bash
# Measures the table behind surface_flow.repose_angle = "auto" and contact.repose_angle: for every
# pair of friction and rolling friction, heaps are poured onto a rough floor in full DEM, and their
# angles of repose are averaged. Writes src/scene/repose_measurements.inc, or the file named.
#
#   scripts/measure_repose.sh [FILE]
#   WORK=angles JOBS=2 scripts/measure_repose.sh     # stopped, it goes on where it was
#
# GRAINS (8000) a heap, SEEDS ("1 2 3"), FRICTION and ROLLING (the table's values), JOBS (all
# processors) heaps at a time, one thread each; SANDFLOW (the executable; built if not given); SET
# ("KEY=VALUE ...", other values for scene keys, to see what the angle depends on); WORK (a folder
# to keep the angles in, angles.csv; else it is removed). About 20 s of processor time a heap.
# Exit code: 0 done, 2 wrong usage or settings, 4 a run failed or a heap has no flank to measure.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
table=${1:-$root/src/scene/repose_measurements.inc}
grains=${GRAINS:-8000}
read -r -a seeds <<<"${SEEDS:-1 2 3}"
read -r -a frictions <<<"${FRICTION:-0.1 0.2 0.3 0.5 0.7 1.0}"
read -r -a rollings <<<"${ROLLING:-0.0 0.02 0.05 0.1 0.2 0.4}"
read -r -a changes <<<"${SET:-}"
if [ $# -gt 1 ] || [[ ${1:-} == -* ]]; then
    echo "usage: scripts/measure_repose.sh [FILE]" >&2
    exit 2
fi
for number in "$grains" "${JOBS:-1}" "${seeds[@]}"; do
    [[ $number =~ ^[0-9]+$ ]] || { echo "measure_repose.sh: $number is no number" >&2; exit 2; }
done

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

# A thin slow jet onto an endless rough floor. All else is default.
cat >"$work/heap.new" <<EOF
# ${SET:-nothing else set}
name = "heap"
mode = "dem"

[[solids]]
shape = "plane"

[[emitters]]
kind = "jet"
count = $grains
rate = 3000
position = [0, 0, 0.35]
radius = 0.05
speed = 1.3
EOF
if [ -f "$work/heap.toml" ] && ! cmp -s "$work/heap.toml" "$work/heap.new"; then
    echo "measure_repose.sh: $work holds angles of other heaps; give WORK another folder" >&2
    exit 2
fi
mv "$work/heap.new" "$work/heap.toml"

# measure FRICTION ROLLING SEED: adds "friction,rolling,seed,angle" to angles.csv.
measure()
{
    local run=$work/$1-$2-$3 set=() change angle
    if grep -q "^$1,$2,$3," "$work/angles.csv"; then
        return
    fi
    for change in "contact.friction=$1" "contact.rolling_friction=$2" "${changes[@]}"; do
        set+=(--set "$change")
    done
    nice "$SANDFLOW" run "$work/heap.toml" --out "$run" --force --quiet --no-frames --threads 1 \
        --seed "$3" "${set[@]}" >"$run.log" 2>&1 || {
        echo "measure_repose.sh: $1, $2, seed $3: $(tail -1 "$run.log")" >&2
        return 4
    }
    angle=$(awk '/"repose_deg":/ { gsub(/,/, ""); print $2 }' "$run/summary.json")
    [[ $angle =~ ^[0-9.]+$ ]] || {
        echo "measure_repose.sh: $1, $2, seed $3: the heap has no flank to measure" >&2
        return 4
    }
    echo "$1,$2,$3,$angle" >>"$work/angles.csv"
    rm -rf "$run" "$run.log"
}

touch "$work/angles.csv"
rm -f "$work/failed"
started=$(date +%s)
for seed in "${seeds[@]}"; do  # one whole table after the other
    for friction in "${frictions[@]}"; do
        for rolling in "${rollings[@]}"; do
            while [ "$(jobs -rp | wc -l)" -ge "${JOBS:-$(nproc)}" ]; do
                wait -n || true
            done
            measure "$friction" "$rolling" "$seed" || touch "$work/failed" &
        done
    done
done
wait
if [ -f "$work/failed" ]; then
    echo "measure_repose.sh: no table was written" >&2
    exit 4
fi

{
    echo "// Angle of repose of heaps poured in full DEM: friction, rolling friction, mean"
    echo "// [degrees], standard deviation over the seeds [degrees], heaps."
    echo "// $(date -u +%F), $("$SANDFLOW" --version | head -1), sources" \
        "$(git -C "$root" describe --always 2>/dev/null || echo unknown):"
    echo "// scripts/measure_repose.sh, $grains grains a heap, seeds ${seeds[*]}${SET:+, $SET}"
    awk -F, -v frictions="${frictions[*]}" -v rollings="${rollings[*]}" -v seeds="${seeds[*]}" '
        { angle[$1, $2, $3] = $4 }
        END {
            columns = split(rollings, rolling, " ")
            rows = split(frictions, friction, " ")
            count = split(seeds, seed, " ")
            for (i = 1; i <= rows; ++i) for (j = 1; j <= columns; ++j) {
                sum = squares = 0
                for (s = 1; s <= count; ++s) sum += angle[friction[i], rolling[j], seed[s]]
                mean = sum / count
                for (s = 1; s <= count; ++s)
                    squares += (angle[friction[i], rolling[j], seed[s]] - mean) ^ 2
                scatter = (count > 1) ? sqrt(squares / (count - 1)) : 0
                printf "{%s, %s, %.2f, %.2f, %d},\n", friction[i], rolling[j], mean, scatter, count
            }
        }' "$work/angles.csv"
} >"$table.new"
mv "$table.new" "$table"
echo "$table: $((${#frictions[@]} * ${#rollings[@]})) values in $(($(date +%s) - started)) s"
