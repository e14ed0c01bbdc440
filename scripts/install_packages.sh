#!/usr/bin/env bash
# Installs the Debian 12 packages that building, testing and rendering need; only the missing ones.
# Names given as arguments are installed too. As root, or as a user who may sudo.
set -euo pipefail

packages=(g++ cmake ninja-build libeigen3-dev libassimp-dev libgsl-dev libtomlplusplus-dev
    libcli11-dev libfmt-dev zlib1g-dev libgtest-dev librapidcheck-dev libhwy-dev
    povray gnuplot-nox "$@")

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
    [ "$status" = "install ok installed" ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "installing: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        echo "packages are missing (${missing[*]}) and there is no sudo: install them as root" >&2
        exit 4
    }
    as_root=(sudo)
fi
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}"
