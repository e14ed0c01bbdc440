#!/usr/bin/env bash
# Renders frames of a run with POV-Ray, as stills or as a movie.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

usage()
{
    cat <<'END'
usage: scripts/render.sh RUN [options]

Renders the last frame of the run folder RUN, or the frames asked for, one POV-Ray process per
core. A frame that is already there, as large and as good as asked for and newer than what it was
made from, is not rendered again: a call that was interrupted goes on where it was.

  --frames A:B       frames A to B; a single number is one frame. Default: the last one there is,
                     for a movie all
  --size WxH         pixels (default 1280x720, for --quality preview 640x360)
  --quality Q        preview: hard shadows, no antialiasing
                     movie (default): soft light, nothing random
                     final: radiosity and finer antialiasing; several times slower
  --movie            also joins the frames to a movie (installs ffmpeg if there is none)
  --jobs N           processes at a time (default: as many as cores)
  --out DIR          where the pictures go (default RUN)
  --help             this text

Writes DIR/frame_NNNNNN.png, DIR/movie.mp4 and, to know what it did, DIR/render_settings.txt.
Exit code: 0 done, 2 bad input, 4 a frame or the movie could not be made.
END
}
refuse()
{
    echo "render.sh: $*" >&2
    exit 2
}
fail()
{
    echo "render.sh: $*" >&2
    exit 4
}

run=
frames=
size=
quality=movie
movie=no
jobs=$(nproc)
out=
while [ $# -gt 0 ]; do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --movie) movie=yes; shift; continue ;;
        --*=*) set -- "${1%%=*}" "${1#*=}" "${@:2}" ;;
    esac
    case $1 in
        --frames | --size | --quality | --jobs | --out)
            [ $# -ge 2 ] || refuse "$1 needs a value"
            [ -n "$2" ] || refuse "$1 needs a value, not an empty one"
            declare "${1#--}=$2"
            shift 2
            ;;
        -*) refuse "unknown option $1; see --help" ;;
        *)
            [ -z "$run" ] || refuse "one run folder at a time, not $run and $1"
            [ -n "$1" ] || refuse "the name of the run folder is empty"
            run=$1
            shift
            ;;
    esac
done

[ -n "$run" ] || refuse "which run folder? See --help"
[ -d "$run" ] || refuse "$run: no such run folder"
[ -f "$run/frames.csv" ] || refuse "$run holds no run: there is no frames.csv in it"
[ -f "$run/run_scene.inc" ] && [ -f "$run/scene.pov" ] && [ -f "$run/scene.ini" ] ||
    refuse "$run holds nothing to draw: it was run with --no-frames"

declared()
{
    local value
    value=$(sed -n "s/^#declare $1 = \([0-9.e+-]*\);.*/\1/p" "$run/run_scene.inc")
    [ -n "$value" ] || refuse "$run/run_scene.inc does not declare $1"
    echo "$value"
}
frame_count=$(declared NFrames)
frames_per_second=$(declared FramesPerSecond)

# A quality's number in scene.pov, its size and what differs from scene.ini.
case $quality in
    preview) level=0 default_size=640x360 antialias=(-A) ;;
    movie) level=1 default_size=1280x720 antialias=() ;;
    final) level=2 default_size=1280x720 antialias=(+A0.1 +AM2 +R2) ;;
    *) refuse "--quality $quality: use preview, movie or final" ;;
esac
size=${size:-$default_size}
[[ $size =~ ^([1-9][0-9]{1,4})x([1-9][0-9]{1,4})$ ]] &&
    width=${BASH_REMATCH[1]} height=${BASH_REMATCH[2]} &&
    ((width >= 16 && width <= 16384 && height >= 16 && height <= 16384)) ||
    refuse "--size $size: expected WIDTHxHEIGHT, each 16 to 16384, as in 1280x720"
[[ $jobs =~ ^[1-9][0-9]{0,2}$ ]] || refuse "--jobs $jobs: expected a number from 1 to 999"

include_of() { printf '%s/frame_%06d.inc' "$run" "$1"; }

newest=$frame_count
while ((newest > 0)) && [ ! -f "$(include_of "$newest")" ]; do
    newest=$((newest - 1))
done
((newest > 0)) || refuse "$run holds no frame yet"
if [ -n "$frames" ]; then
    [[ $frames =~ ^([0-9]{1,9})(:([0-9]{1,9}))?$ ]] ||
        refuse "--frames $frames: expected A:B or a single number"
    first=$((10#${BASH_REMATCH[1]}))
    last=$((10#${BASH_REMATCH[3]:-${BASH_REMATCH[1]}}))
    ((first <= last)) || refuse "--frames $frames: the first frame is after the last"
    ((first >= 1 && last <= frame_count)) ||
        refuse "--frames $frames: the frames of $run are 1 to $frame_count"
elif [ $movie = yes ]; then
    first=1
    last=$newest
    ((newest == frame_count)) ||
        echo "render.sh: of the run's $frame_count frames $newest are there so far" >&2
else
    first=$newest
    last=$newest
fi

out=${out:-$run}
[ ! -e "$out" ] || [ -d "$out" ] || refuse "--out $out is not a folder"
mkdir -p "$out" || fail "cannot make the folder $out"
run=$(cd "$run" && pwd)
out=$(cd "$out" && pwd)
command -v povray >/dev/null || "$root/scripts/install_packages.sh"
[ $movie = no ] || command -v ffmpeg >/dev/null || "$root/scripts/install_packages.sh" ffmpeg

picture_of() { printf '%s/frame_%06d.png' "$out" "$1"; }

# Pictures older than this file were made with other settings.
settings=$out/render_settings.txt
wanted="$size $quality"
[ -f "$settings" ] && [ "$(cat "$settings")" = "$wanted" ] ||
    { echo "$wanted" >"$settings"; } 2>/dev/null || fail "cannot write $settings"

# A picture also depends on camera, solids, materials and lights.
newest_source=$settings
for source in "$run"/{run_scene,materials,lights}.inc "$run"/solid_*.inc "$run"/scene.{pov,ini}; do
    [ ! "$source" -nt "$newest_source" ] || newest_source=$source
done
todo=()
for ((frame = first; frame <= last; ++frame)); do
    include=$(include_of "$frame")
    picture=$(picture_of "$frame")
    [ -f "$include" ] || fail "frame $frame cannot be rendered: $include is missing"
    [ "$picture" -nt "$include" ] && [ "$picture" -nt "$newest_source" ] || todo+=("$frame")
done

declare -A frame_of=()  # by process
work=$(mktemp -d)
# Pictures take their names when they are whole; until then they are part_<call>_<frame>_*.
part=part_$$
clean_up()
{
    if [ ${#frame_of[@]} -gt 0 ]; then
        kill "${!frame_of[@]}" 2>/dev/null || true
        wait "${!frame_of[@]}" 2>/dev/null || true
    fi
    rm -rf "$work" "$run/$part"_* "$out/$part"_*
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# Where there are fewer frames than cores, a frame may use several.
threads=1
((${#todo[@]} == 0)) || threads=$((jobs / ${#todo[@]}))
((threads >= 1)) || threads=1
# With a last frame of 1, POV-Ray would count it as frame 0.
final=$((frame_count >= 2 ? frame_count : 2))

start_frame()
{
    # In the run's folder, for that is where POV-Ray may read and write whatever its restrictions.
    (cd "$run" && exec povray scene.ini "+W$width" "+H$height" "Declare=Quality=$level" \
        "${antialias[@]}" "+O${part}_$1_.png" +KFI1 "+KFF$final" "+SF$1" "+EF$1" "+WT$threads" \
        -D -V -GD -GR -GS >"$work/$1.log" 2>&1 </dev/null) &
    frame_of[$!]=$1
}
# Waits for one process to end and gives its picture the right name.
finish_frame()
{
    local process status=0
    wait -n -p process "${!frame_of[@]}" || status=$?
    local frame=${frame_of[$process]}
    unset "frame_of[$process]"
    local made=("$run/${part}_${frame}_"*.png)
    if [ $status -ne 0 ] || [ ! -f "${made[0]}" ]; then
        echo "render.sh: frame $frame failed; POV-Ray's last words:" >&2
        grep -v '^ *$' "$work/$frame.log" | tail -n 5 >&2 || true
        exit 4
    fi
    # Another file system may be slow to fill; the name must come last there, too.
    mv "${made[0]}" "$out/${part}_$frame.done" && mv "$out/${part}_$frame.done" \
        "$(picture_of "$frame")" || fail "cannot write $(picture_of "$frame")"
    done_count=$((done_count + 1))
    [ ! -t 1 ] || printf '\r%d of %d frames' "$done_count" ${#todo[@]}
}

done_count=0
for frame in "${todo[@]}"; do
    while [ ${#frame_of[@]} -ge "$jobs" ]; do
        finish_frame
    done
    start_frame "$frame"
done
while [ ${#frame_of[@]} -gt 0 ]; do
    finish_frame
done
[ ! -t 1 ] || [ "$done_count" -eq 0 ] || echo

if ((first == last)); then
    echo "picture: $(picture_of "$last")"
else
    echo "pictures: $(picture_of "$first") to $(basename "$(picture_of "$last")")," \
        "$done_count rendered, $((last - first + 1 - done_count)) were there"
fi

if [ $movie = yes ]; then
    # 4:2:0 and the tags of HD video, so that every player shows it, and in the right colours; the
    # index first, so that it plays while it loads.
    even="scale=trunc(iw/2)*2:trunc(ih/2)*2:out_color_matrix=bt709:out_range=tv,format=yuv420p"
    ffmpeg -y -loglevel error -framerate "$frames_per_second" -start_number "$first" \
        -i "$out/frame_%06d.png" -frames:v $((last - first + 1)) -vf "$even" \
        -c:v libx264 -preset slow -crf 18 -colorspace bt709 -color_primaries bt709 \
        -color_trc bt709 -color_range tv -movflags +faststart -f mp4 "$out/${part}_movie" \
        >"$work/movie.log" 2>&1 </dev/null || {
        echo "render.sh: the movie failed; ffmpeg's last words:" >&2
        tail -n 8 "$work/movie.log" >&2
        exit 4
    }
    mv "$out/${part}_movie" "$out/movie.mp4"
    echo "movie: $out/movie.mp4"
fi
