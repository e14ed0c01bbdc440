#!/usr/bin/env bash
# Published numbers beside ours: builds, runs the fast cases and then those that take minutes (one
# pour each; three with --full), and writes tests/verification/results.csv. Fails if a number that is
# judged does not hold.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
table="$root/tests/verification/results.csv"

seeds=1
case "${1:-}" in
    "") ;;
    --full) seeds=3 ;;
    *)
        echo "usage: scripts/verify.sh [--full]" >&2
        exit 2
        ;;
esac

"$root/scripts/build.sh" verify
verify="$root/build/verify"
parts=$(mktemp -d)
trap 'rm -rf "$parts"' EXIT

# Waiting threads must not burn the processors that others run on.
export OMP_WAIT_POLICY=passive
failed=0
"$verify" --csv "$parts/fast.csv" || failed=1
"$verify" --bulk --seeds "$seeds" --threads "$(nproc)" --csv "$parts/bulk.csv" || failed=1

# A commit is named only if what ran is what was committed.
commit=$(git -C "$root" describe --always --dirty --abbrev=10 --exclude '*' 2>/dev/null || echo none)
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$root/build/CMakeCache.txt")
cpu=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1)
{
    echo "# $(date -u +%Y-%m-%d), commit $commit, $("$compiler" --version | head -n 1)," \
        "${cpu:-$(uname -m)}, bulk cases with $seeds pour(s)"
    cat "$parts/fast.csv"
    tail -n +2 "$parts/bulk.csv"
} > "$parts/results.csv"
mv "$parts/results.csv" "$table"
echo "table: $table"
exit "$failed"
