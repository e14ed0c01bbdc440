#!/usr/bin/env bash
# Installs, builds, pours the paper's Figure 3 (107,687 grains, surface flow) and renders its last
# frame at 1280 x 720. A step whose result is already there is not done again.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
run=$root/runs/floor-surface-flow
picture=$root/runs/floor.png

"$root/scripts/build.sh" sandflow

# summary.json is written last: with it, the run is complete. A newer program makes it stale.
if [ ! -f "$run/summary.json" ] || [ "$root/build/sandflow" -nt "$run/summary.json" ] ||
    [ "$root/scenes/floor.toml" -nt "$run/summary.json" ]; then
    "$root/build/sandflow" run "$root/scenes/floor.toml" --out "$run" --force
fi

if [ ! -f "$picture" ] || [ "$run/summary.json" -nt "$picture" ]; then
    echo "rendering the last frame ..."
    rm -f "$run/demo.png"
    (cd "$run" && povray scene.ini +W1280 +H720 +Odemo.png -D -V -GD -GR -GS >povray.log 2>&1) || {
        echo "povray failed; its last words:" >&2
        tail -n 20 "$run/povray.log" >&2
        exit 1
    }
    cp "$run/demo.png" "$picture"
fi
echo "picture: $picture"
