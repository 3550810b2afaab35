#!/usr/bin/env bash
# Draws the pictures of docs/beside.md: ten moments, each by Kinescope, by RViz with Kinescope's URDF and topics, and by F3D with
# the exported GLB, from the same camera; and writes the list of moments, with the agreement of the outlines and the versions.
# docs/beside.sh [PROGRAM [MOMENT...]]
# Needs f3d, rviz, xvfb, imagemagick and python3-rosmaster. f3d is for this page only, so it is not in packages.txt.
set -euo pipefail

need() { command -v "$1" >/dev/null || { echo "docs/beside.sh: '$1' is missing; install it: apt-get install $2" >&2; exit 2; }; }
PATH=$PATH:/usr/lib/rviz
need f3d f3d
need rviz rviz
need Xvfb xvfb
need montage imagemagick
need rosmaster python3-rosmaster
cd "$(dirname "$0")/.."
program=$(realpath "${1:-build/dev/bin/kinescope}")
[ -x "$program" ] || { echo "docs/beside.sh: $program is missing; build it (CONTRIBUTING.md), or name the program" >&2; exit 2; }
only=("${@:2}")

width=440 height=560
background='#eceff4'
work=$(mktemp -d)
children=()
trap 'kill "${children[@]}" 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$work"' EXIT
port_of() { /usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }

start_display_and_master() {
  local port
  mkfifo "$work/display"
  # Without -noreset the server starts anew when RViz ends, and refuses the next one meanwhile.
  Xvfb -displayfd 3 -noreset -screen 0 ${width}x${height}x24 3>"$work/display" 2>/dev/null & children+=($!)
  read -r DISPLAY <"$work/display"
  port=$(port_of)
  export DISPLAY=:$DISPLAY ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_HOME=$work/ros HOME=$work
  export LIBGL_ALWAYS_SOFTWARE=1 QT_LOGGING_RULES='*=false'
  unset ROS_HOSTNAME
  /usr/bin/python3 "$(command -v rosmaster)" --core -p "$port" >/dev/null 2>&1 & children+=($!)
  until (: >"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do sleep 0.1; done
}

# write_rviz_config VIEW: of the shipped configuration the floor, the person and the loads, and the properties of the view.
write_rviz_config() {
  cat >"$work/peer.rviz" <<CONFIG
Panels: []
Visualization Manager:
  Class: ""
  Displays:
$(sed -n '/^    - Class: rviz\/Grid/,/^    - Class: rviz\/Camera/p' launch/kinescope.rviz | sed "\$d; s/Alpha: 0.6/Alpha: $opacity/")
  Enabled: true
  Global Options: {Background Color: 236; 239; 244, Default Light: true, Fixed Frame: world, Frame Rate: 30}
  Tools: [{Class: rviz/Interact}]
  Value: true
  Views:
    Current: {Class: rviz/Orbit, Name: Current View, Target Frame: <Fixed Frame>, Near Clip Distance: 0.01, Focal Shape Fixed Size: false, Focal Shape Size: 0.0001, $1}
    Saved: ~
Window Geometry: {Height: $height, Width: $width, X: 0, Y: 0, Hide Left Dock: true, Hide Right Dock: true}
CONFIG
}

# draw_in_rviz MOMENT.mvnx OUT OPTION...: the first picture that the next one repeats and whose outline agrees with parts_outline.png.
# RViz does not tell when it has loaded the body.
draw_in_rviz() {
  local moment=$1 out=$2 bridge peer tries
  shift 2
  : >"$work/bridge.log"
  "$program" bridge --source "$moment" --loop --ros required "$@" 2>"$work/bridge.log" & bridge=$!
  until grep -q live: "$work/bridge.log"; do kill -0 $bridge || { cat "$work/bridge.log" >&2; return 1; }; sleep 0.1; done
  rviz -d "$work/peer.rviz" --fullscreen --splash-screen '' >"$work/rviz.log" 2>&1 & peer=$!
  children+=("$bridge" "$peer")
  rm -f "$work/before.png"
  for ((tries = 0; tries < 60; ++tries)); do
    kill -0 $peer || { tail -5 "$work/rviz.log" >&2; return 1; }
    import -window root "$out"
    if [ -f "$work/before.png" ] && [ "$(compare -metric AE "$out" "$work/before.png" null: 2>&1)" = 0 ]; then
      outline "$out" "$work/rviz_outline.png"
      with_rviz=$(agreement "$work/parts_outline.png" "$work/rviz_outline.png")
      if is_above "$with_rviz" 0.9; then break; fi
    fi
    cp "$out" "$work/before.png"
    sleep 0.5
  done
  kill $peer $bridge
  wait $peer $bridge 2>/dev/null || true
  [ "$tries" -lt 60 ] || fail_pair
}

# Where to look after a failure.
fail_pair() {
  cp "$work"/*.png "$work/person.glb" out/ 2>/dev/null || true
  echo "docs/beside.sh: $name: outlines agree by ${with_rviz:-0} (RViz) and ${with_f3d:-0} (F3D) only, so these are not the same moment" \
    "from the same camera; see the pictures in out/" >&2
  return 1
}

is_above() { awk -v value="$1" -v least="$2" 'BEGIN { exit !(value > least) }'; }

# outline PICTURE OUT: white where RViz's picture shows more than background and lines.
outline() {
  convert "$1" -alpha off -fuzz 4% -fill white +opaque "$background" -fuzz 0 -fill black +opaque white -colorspace Gray \
    -morphology Open Disk:2 "$2"
}

# outline_of NAME: of NAME.png with a transparent background, as NAME_outline.png.
outline_of() { convert "$work/$1.png" -alpha extract -threshold 50% -morphology Open Disk:2 "$work/$1_outline.png"; }

# agreement A B: area that both outlines cover, of the area that one of them covers.
agreement() {
  local both one
  both=$(convert "$1" "$2" -evaluate-sequence min -format '%[fx:mean]' info:)
  one=$(convert "$1" "$2" -evaluate-sequence max -format '%[fx:mean]' info:)
  awk -v both="$both" -v one="$one" 'BEGIN { printf "%.2f", both / one }'
}

# A rod of 30 cm, for a hand to hold.
write_rod() {
  /usr/bin/python3 -c '
x, y, z = (-0.015, 0.015), (-0.015, 0.015), (-0.15, 0.15)
corners = [(x[i & 1], y[i >> 1 & 1], z[i >> 2]) for i in range(8)]
quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
print("solid rod")
for a, b, c, d in quads:
    for triangle in ((a, b, c), (a, c, d)):
        print("facet normal 0 0 0 outer loop", *(f"vertex {corners[i][0]} {corners[i][1]} {corners[i][2]}" for i in triangle), "endloop endfacet", sep="\n")
print("endsolid")' >"$work/rod.stl"
}

page=()
# pair NAME "CAPTION" DEMO SECONDS "DISTANCE FROM_FRONT UP AHEAD HEIGHT" [OPTION VALUE]...
# The camera looks at a point AHEAD of the pelvis, m, and HEIGHT above the floor; it stands DISTANCE away, FROM_FRONT degrees from the
# person's front to their left, and UP degrees above that point. RViz draws the body with the opacity $opacity.
pair() {
  local name=$1 caption=$2 demo=$3 secs=$4 place=$5 person=() held=()
  shift 5
  while [ $# -gt 0 ]; do
    case $1 in --hand_load | --tool) held+=("$1" "$2") ;; *) person+=("$1" "$2") ;; esac
    shift 2
  done
  if [ ${#only[@]} -gt 0 ] && [[ " ${only[*]} " != *" $name "* ]]; then return; fi
  local distance from_front up ahead z pelvis_x pelvis_y heading x y eye_x eye_y eye_z yaw pitch
  read -r distance from_front up ahead z <<<"$place"
  "$program" convert "$demo" --seconds "$secs" "${person[@]}" --out "$work/motion.mvnx" >/dev/null
  read -r pelvis_x pelvis_y heading < <(docs/hold.py "$work/motion.mvnx" "$work/moment.mvnx")
  read -r x y eye_x eye_y eye_z yaw pitch < <(awk -v d="$distance" -v turn="$from_front" -v up="$up" -v x="$pelvis_x" -v y="$pelvis_y" \
    -v z="$z" -v h="$heading" -v ahead="$ahead" 'BEGIN {
    degree = atan2(0, -1) / 180; yaw = (h + turn) * degree; pitch = up * degree; x += ahead * cos(h * degree); y += ahead * sin(h * degree)
    printf "%.4f %.4f %.4f %.4f %.4f %.5f %.5f\n", x, y, x + d * cos(yaw) * cos(pitch), y + d * sin(yaw) * cos(pitch), z + d * sin(pitch), yaw, pitch }')

  local render=("$program" render "$work/moment.mvnx" --time 0.5 "${person[@]}" --camera "$eye_x,$eye_y,$eye_z:$x,$y,$z" --fov 45
    --size ${width}x${height} --no_overlays --no_sidecar)
  "${render[@]}" "${held[@]}" --background "$background" --out "$work/ours.png" >/dev/null
  local outline_only=(--background transparent --floor off)
  "${render[@]}" "${held[@]}" "${outline_only[@]}" --hide shadows --figure urdf --out "$work/parts.png" >/dev/null
  "${render[@]}" "${outline_only[@]}" --hide loads,com,cop,support,forces,hand_loads,shadows --out "$work/skin.png" >/dev/null

  local with_rviz with_f3d
  outline_of parts
  outline_of skin
  write_rviz_config "Distance: $distance, Yaw: $yaw, Pitch: $pitch, Focal Point: {X: $x, Y: $y, Z: $z}"
  draw_in_rviz "$work/moment.mvnx" "$work/rviz.png" "${person[@]}" "${held[@]}"

  "$program" urdf "$work/moment.mvnx" --time 0.5 --no_skeleton "${person[@]}" --out "$work/person.glb" >/dev/null
  # x of the file is y of the world, y is z, z is x.
  local f3d=(f3d --dry-run --quiet --fxaa --ssao --bg-color=0.92549,0.93725,0.95686 --camera-position="$eye_y,$eye_z,$eye_x"
    --camera-focal-point="$y,$z,$x" --camera-view-up=0,1,0 --camera-view-angle=45 --resolution=$width,$height)
  "${f3d[@]}" --output "$work/f3d.png" "$work/person.glb"
  "${f3d[@]}" --no-background --output "$work/f3d_alpha.png" "$work/person.glb"

  outline_of f3d_alpha
  with_f3d=$(agreement "$work/skin_outline.png" "$work/f3d_alpha_outline.png")
  is_above "$with_f3d" 0.95 || fail_pair
  echo "$name: outlines agree by $with_rviz (RViz) and $with_f3d (F3D)"
  montage -font DejaVu-Sans -pointsize 13 -label Kinescope "$work/ours.png" -label RViz "$work/rviz.png" -label F3D "$work/f3d.png" -tile 3x1 \
    -geometry +2+2 -background white -quality 82 -sampling-factor 4:2:0 -strip "docs/beside/$name.jpg"
  local options="${person[*]} ${held[*]}"
  options=${options//"$work/"/}
  page+=("### $caption" "" "\`$demo\` at $secs s$([ "$options" = ' ' ] || sed 's/^ */, `/; s/ *$/`/' <<<"$options"). Agreement of the outlines: RViz $with_rviz, F3D $with_f3d." ""
    "![$caption: Kinescope, RViz, F3D](beside/$name.jpg)" "")
}

# Between the two marks of docs/beside.md.
write_page() {
  local version_of=(dpkg-query -W -f '${Version}')
  {
    sed '/^<!-- moments -->$/q' docs/beside.md
    echo
    echo "Kinescope $("$program" --version | grep -o '[0-9.]*' | head -1), RViz $("${version_of[@]}" rviz), F3D $("${version_of[@]}" f3d) with VTK $(f3d --version |
      sed -n 's/^VTK version: \([0-9.]*\).*/\1/p'), all on Mesa's llvmpipe (no GPU)."
    echo
    printf '%s\n' "${page[@]}"
    sed -n '/^<!-- end of moments -->$/,$p' docs/beside.md
  } >"$work/page.md"
  cp "$work/page.md" docs/beside.md
}

mkdir -p docs/beside out
start_display_and_master
write_rod
opacity=0.6 pair lift "Bent over a box of 8 kg" demo:lift 1.2 "1.9 40 12 0.2 0.45" --hand_load both:8
opacity=1
pair lift_side "A woman lifts" demo:lift 2.1 "1.8 -90 5 0.2 0.45" --sex female --height 1.62 --hand_load both:5
pair reach "Reaching forward" demo:lift 3.9 "2.6 -40 12 0.25 0.85"
pair walk "Walking" demo:walk 0.6 "2.5 70 8 0 0.85"
pair walk_behind "A woman walks, from behind" demo:walk 2.3 "2.5 150 20 0 0.8" --sex female --height 1.62
pair squat "Squatting, arms forward" demo:squat 1 "2.2 35 15 0.35 0.6"
pair squat_side "A heavier woman squats" demo:squat 1 "2 -90 5 0.35 0.6" --sex female --height 1.68 --mass 90
pair sit "Sitting" demo:sit 1 "2.1 50 20 0.2 0.65"
pair overhead "Arms overhead" demo:overhead 1 "2.9 20 5 0 1.1"
pair hands "Hands, the right one with a rod" demo:lift 3 "1.2 25 20 0.3 0.95" --tool "right:$work/rod.stl"
[ ${#page[@]} -gt 0 ] || { echo "docs/beside.sh: no moment is called '${only[*]}'; see the end of this file" >&2; exit 2; }
[ ${#only[@]} -gt 0 ] || write_page
