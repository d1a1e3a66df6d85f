#!/usr/bin/env bash
# Digs, places, takes back and lights in a window under Xvfb, as a person would, and compares what the window shows. Any validation message
# fails it.
# usage: dig_test.sh SKERRY_PROGRAM [FOLDER]     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or ImageMagick here
# The pictures are left in FOLDER, if one is given.
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
key_pause=0.7
start_display convert compare import
pictures=${2:-$work}
mkdir -p "$pictures"

play --seed 1 --time 22:00 --set view.distance=64
wait_for_frames
wait_until_quick
sleep 2

# In several motions: one alone may be taken for the pointer's first place.
turn() { for _ in 1 2 3 4; do xdotool mousemove_relative -- $(($1 / 4)) $(($2 / 4)); sleep 0.3; done; sleep 0.5; }
grab() { import -silent -window "$window" "$pictures/$1.png"; }
brightness() { convert "$pictures/$1.png" -colorspace gray -format '%[fx:mean]' info:; }
# Pixels that differ by more than 6%, of the lower half: islands drift behind the upper one.
changed() {
  compare -metric AE -fuzz 6% "$pictures/$1.png[320x90+0+90]" "$pictures/$2.png[320x90+0+90]" null: 2>&1 || true
}
expect_change() {  # FROM TO LEAST WHAT
  local count
  count=$(changed "$1" "$2")
  awk -v c="$count" -v least="$3" 'BEGIN { exit !(c >= least) }' || fail "$4 changed $count pixels only"
}

# The day stands still, the head looks down at the ground three blocks ahead, the eye has adapted.
key p
turn 0 300
sleep 6
grab night

# A torch on the ground: the night is lit within a second or two.
key 1
xdotool click 3
for _ in 1 2 3 4 5; do  # longer where the machine has other work
  sleep 3
  grab torch
  count=$(changed night torch)
  awk -v c="$count" 'BEGIN { exit !(c >= 2000) }' && break
done
awk -v a="$(brightness night)" -v b="$(brightness torch)" 'BEGIN { exit !(b > a) }' || fail "the torch gave no light"
expect_change night torch 2000 "a torch at night"

# Taking it back makes it dark again, doing it again lights it.
key ctrl+z 6
grab undone
awk -v a="$(brightness undone)" -v b="$(brightness torch)" 'BEGIN { exit !(b > a) }' || fail "undo left the light on"
key ctrl+y 4
grab redone
expect_change undone redone 2000 "doing it again"

# In its light: dig a hole, put a block of planks into it, take that back.
turn 60 160
sleep 3
grab ground
xdotool mousedown 1
sleep 0.8
xdotool mouseup 1
sleep 3
grab hole
expect_change ground hole 600 "digging"
key 3
xdotool click 3
sleep 3
grab planks
expect_change hole planks 300 "placing planks"
key ctrl+z 3
grab hole_again
expect_change planks hole_again 300 "undoing the planks"
# The middle button takes the block looked at, the wheel chooses others: nothing of the world changes.
xdotool click 2
xdotool click 4
xdotool click 5
sleep 1
alive "after picking a block"

# Walking: the picture follows.
xdotool keydown w
sleep 2
xdotool keyup w
sleep 1
grab walked
expect_change hole_again walked 1500 "walking"

quit
[ ! -s "$work/err" ] || fail "it complained"
echo "passed"
