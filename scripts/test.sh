#!/usr/bin/env bash
# Installs, builds and runs every test.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

"$root/scripts/install_packages.sh" ffmpeg  # a test makes a movie
"$root/scripts/build.sh"
ctest --test-dir "$root/build" --output-on-failure -j 2
