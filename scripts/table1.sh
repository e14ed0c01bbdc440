#!/usr/bin/env bash
# Runs the five scenes of the paper's Table 1 and prints the table with our columns beside it.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

usage()
{
    cat <<'END'
usage: scripts/table1.sh [--twins] [--out DIR] [SCENE...]

Runs floor, terrain, bowl, dragon and armadillo (or the scenes named) in surface-flow mode, and the
floor in dem mode too; with --twins every one in dem mode. A run that is there already is not made
again unless the program or the scene is newer. Writes DIR/table1.md and DIR/table1.csv (default
DIR: runs) and prints the first.

  paper        grains, share computed and seconds per frame of Zhu & Yang (2010), Table 1
  mobile, ...  grains at the end of the run; asleep ones are mobile too
  computed     (mobile - asleep) over all grains, mean over the last second of pouring
  s/frame      wall time, frame output included, from the first grain to 0.5 s after the last

SANDFLOW names the executable (built if not given), THREADS the number of threads (all).
Exit code: 0 done, 2 bad input; that of the program where a run fails.
END
}
twins=no
out=$root/runs
scenes=()
while [ $# -gt 0 ]; do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --twins) twins=yes ;;
        --out)
            [ $# -ge 2 ] || { echo "table1.sh: --out needs a folder" >&2; exit 2; }
            out=$2
            shift
            ;;
        -*) echo "table1.sh: unknown option $1 (see --help)" >&2; exit 2 ;;
        *)
            [ -f "$root/scenes/$1.toml" ] || {
                echo "table1.sh: no scene scenes/$1.toml" >&2
                exit 2
            }
            scenes+=("$1")
            ;;
    esac
    shift
done
[ ${#scenes[@]} -gt 0 ] || scenes=(floor terrain bowl dragon armadillo)
if [ -z "${SANDFLOW:-}" ]; then
    "$root/scripts/build.sh" sandflow >/dev/null
    SANDFLOW=$root/build/sandflow
fi
mkdir -p "$out"
out=$(cd "$out" && pwd)

# run_scene SCENE MODE: into $out/SCENE-MODE
run_scene()
{
    local folder=$out/$1-$2 scene=$root/scenes/$1.toml
    if [ ! -f "$folder/summary.json" ] || [ "$SANDFLOW" -nt "$folder/summary.json" ] ||
        [ "$scene" -nt "$folder/summary.json" ]; then
        echo "running $1, $2 ..." >&2
        "$SANDFLOW" run "$scene" --mode "$2" --out "$folder" --force --quiet \
            ${THREADS:+--threads "$THREADS"} >"$folder.log" 2>&1 || {
            local code=$?
            echo "table1.sh: $1 ($2) failed; its last words:" >&2
            tail -n 5 "$folder.log" >&2
            exit $code
        }
    fi
}

# value KEY FILE: of a line of summary.json
value() { sed -n "s/^  \"$1\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}\$/\1/p" "$2" | head -n 1; }

# Computed share over the last second of pouring and steps per frame, from frames.csv.
shares()
{
    awk -F, '
        NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k; next }
        {
            ++n
            time[n] = $at["time_s"]; emitted[n] = $at["emitted"]
            awake[n] = $at["mobile"] - $at["asleep"]; steps += $at["steps"]
            if (emitted[n] > emitted[n - 1]) last = time[n]
        }
        END {
            for (k = 1; k <= n; ++k)
                if (time[k] > last - 1 && time[k] <= last && emitted[k] > 0) {
                    share += awake[k] / emitted[k]; ++counted
                }
            printf "%.4f %.0f\n", share / counted, steps / n
        }' "$1"
}

# Scenes, grains, surface grains and seconds per frame of the paper.
paper()
{
    case $1 in
        floor) echo 107687 28410 8.62 ;;
        terrain) echo 199039 48423 18.27 ;;
        bowl) echo 318053 24710 11.01 ;;
        dragon) echo 192975 40043 30.05 ;;
        armadillo) echo 207020 58540 21.54 ;;
        *) echo 0 0 0 ;;
    esac
}

csv=$out/table1.csv
md=$out/table1.md
rows=()
for scene in "${scenes[@]}"; do
    run_scene "$scene" surface-flow
    rows+=("$scene surface-flow")
    if [ "$twins" = yes ] || [ "$scene" = floor ]; then
        run_scene "$scene" dem
        rows+=("$scene dem")
    fi
done

{
    echo "scene,mode,paper_total,paper_surface,paper_s_per_frame,total,mobile,asleep,interface,buried,exited,computed_share,s_per_frame,dt_mean_s,steps_per_frame,leaks,ledger_ok,threads,state_hash"
    for row in "${rows[@]}"; do
        read -r scene mode <<<"$row"
        folder=$out/$scene-$mode
        s=$folder/summary.json
        read -r computed steps <<<"$(shares "$folder/frames.csv")"
        read -r total surface seconds <<<"$(paper "$scene")"
        echo "$scene,$mode,$total,$surface,$seconds,$(value grains "$s"),$(value mobile "$s"),$(value asleep "$s"),$(value interface "$s"),$(value buried "$s"),$(value exited "$s"),$computed,$(value mean_wall_s_per_frame "$s"),$(value dt_mean_s "$s"),$steps,$(value leaks "$s"),$(value ledger_ok "$s"),$(value threads "$s"),$(value state_hash "$s")"
    done
} >"$csv.tmp"
mv "$csv.tmp" "$csv"

awk -F, '
    NR == 1 {
        print "| scene | mode | paper: total | computed | s/frame | ours: total | mobile (asleep) | interface | buried | computed | s/frame | dt, ms | steps/frame | leaks |"
        print "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
        next
    }
    {
        printf "| %s | %s | %d | %.1f %% | %.2f | %d | %d (%d) | %d | %d | %.1f %% | %.3f | %.3f | %d | %d |\n",
            $1, $2, $3, $3 ? 100 * $4 / $3 : 0, $5, $6, $7, $8, $9, $10, 100 * $12, $13, 1000 * $14,
            $15, $16
    }' "$csv" >"$md.tmp"
mv "$md.tmp" "$md"
cat "$md"
echo "written: $md, $csv"
