#!/usr/bin/env bash
# Installs what is missing and builds Release into build/ (only what changed): everything, or the
# targets named as arguments.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

"$root/scripts/install_packages.sh"
if [ ! -f "$root/build/build.ninja" ]; then
    cmake -S "$root" -B "$root/build" -G Ninja -DCMAKE_BUILD_TYPE=Release
fi
cmake --build "$root/build" -j "$(nproc)" ${1:+--target "$@"}
