#!/usr/bin/env bash
# Draws docs/contact_sheet.jpg: every camera, theme, overlay and part of the scene in one picture.
# docs/contact_sheet.sh [PROGRAM]   (needs imagemagick)
# docs/contact_sheet.sh --postures FOLDER [PROGRAM]
#   draws a man and a woman in fourteen postures from four cameras, at 800 px: to look at after every change of the skin;
#   and docs/postures.jpg, a small sheet of them all, a row per posture
set -euo pipefail

# draw_postures FOLDER
draw_postures() {
  local out=$1 tiles=() sex camera sample height
  mkdir -p "$out"
  for sex in male female; do
    height=$([ $sex = male ] && echo 1.75 || echo 1.62)
    "$program" convert demo:t_pose --seconds 0.01 --sex $sex --height "$height" --out "$folder/t_pose.mvnx" > /dev/null
    mapfile -t names < <(docs/postures.py "$folder/t_pose.mvnx" "$folder/$sex.mvnx")
    for sample in "${!names[@]}"; do
      for camera in front right back three_quarter; do
        "$program" render "$folder/$sex.mvnx" --sex $sex --sample "$sample" --camera $camera --size 800x800 --no_overlays \
          --hide loads,com,cop,support,forces --no_sidecar --out "$out/${names[sample]}-$sex-$camera.png" > /dev/null
      done
    done
  done
  for sample in "${!names[@]}"; do
    tiles+=("$out/${names[sample]}"-{male,female}-{front,right,back,three_quarter}.png)
  done
  montage "${tiles[@]}" -tile 8x -geometry 170x170+2+2 -background '#8a9099' -quality 80 docs/postures.jpg
}

postures=''
if [ "${1:-}" = --postures ]; then
  postures=$(realpath "${2:?expected a folder after --postures}")
  shift 2
fi
cd "$(dirname "$0")/.."
program=${1:-build/dev/bin/kinescope}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
if [ -n "$postures" ]; then
  draw_postures "$postures"
  exit
fi
tiles=()

# tile TITLE SOURCE OPTION...
tile() {
  local file=$folder/$(printf %02d ${#tiles[@]}).png title=$1
  shift
  "$program" render "$@" --title "$title" --size 640x360 --no_sidecar --out "$file" > /dev/null
  tiles+=("$file")
}
at() { tile "$1" demo:lift --time "$2" "${@:3}"; }

for camera in front back left right top iso three_quarter; do
  at "camera $camera" 2.9 --camera $camera --hand_load both:8 --overlay=-legend,-time,-status
done
at "orthographic, with a scale" 2.9 --camera right --projection orthographic --overlay title,scale
tile "always the same distance: --fit off" demo:lift --time 1.4 --fit off --overlay title
tile "four views" demo:walk --time 3.3 --views 2x2 --overlay title,names
at "the rigid parts of the URDF, as in RViz" 2.9 --figure urdf --overlay title
at "a colour of one's own" 2.9 --body_color "#5b8bd0" --overlay title
at "load on the skin" 2.9 --loads skin --overlay title
at "one colour" 2.9 --style clay --overlay title
at "lines" 2.9 --style line --overlay title
at "lines and load, white" 1.2 --style line --loads skin --background white --floor off --hide com,cop,support,forces --overlay title
tile "three moments" demo:lift --views time:0,1.2,2.9 --legend below --overlay title,legend
at "legend outside" 2.9 --legend outside --overlay title,legend
at "dark" 2.9 --theme dark --hand_load both:8
at "white, without floor" 2.9 --background white --floor off --hand_load both:8 --overlay title
at "no load in the hands" 2.9
at "18 kg in both hands" 2.9 --hand_load both:18
at "6 kg in the right hand" 1.2 --hand_load right:6
tile "trails and a ghost" demo:lift --time 2.4 --trail com,right_hand --ghost n_pose --overlay title
at "frames of the links" 3.3 --camera front --show link_frames --hide loads,com,cop,support --overlay title
at "axes of the joints" 3.3 --camera front --show joint_axes --hide loads,com,cop,support --overlay title
at "metres and newtons" 2.9 --show scale --overlay title,names
at "loads over time" 2.9 --plot l5_s1,right_knee --hand_load both:8 --overlay=-legend
at "sample and time for machines" 2.9 --overlay title,time,frame_code
at "limits of one's own" 2.9 --class_limits 0.15,0.4
cp golden_images/stale_front.png "$folder/stale.png"
cp golden_images/no_data.png "$folder/no_data.png"
tiles+=("$folder/stale.png" "$folder/no_data.png")

montage "${tiles[@]}" -tile 4x -geometry 480x270+4+4 -background '#8a9099' -quality 80 docs/contact_sheet.jpg
