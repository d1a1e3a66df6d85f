#!/usr/bin/env bash
# Plays in a window under Xvfb, as a person would: keys, screenshot, resizing, minimising, quitting. Any validation message fails it.
# usage: play_test.sh SKERRY_PROGRAM     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or ImageMagick here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
key_pause=0.5
validation=(--validate)
start_display convert identify

play --seed 1 --set view.distance=200
wait_for_frames
xdotool getwindowname "$window" | grep -q 'seed 1' || fail "the title does not name the seed"
wait_until_quick

screenshots() { find "$work/data" -name '*.png' 2>/dev/null | sort; }
has_screenshots() { [ "$(screenshots | wc -l)" -ge "$1" ]; }
wait_for_screenshots() { until_true "screenshot $1 is saved" has_screenshots "$1"; }
grab() { xdotool getwindowgeometry "$window" >/dev/null; import -silent -window "$window" "$1"; }

key F2
wait_for_screenshots 1
first=$(screenshots | head -n 1)
[ "$(identify -format '%wx%h' "$first")" = 320x180 ] || fail "the screenshot has the wrong size: $(identify "$first")"
# Not black, not one colour: a lit world by day.
mean=$(convert "$first" -colorspace gray -format '%[fx:mean]' info:)
spread=$(convert "$first" -colorspace gray -format '%[fx:standard_deviation]' info:)
awk -v m="$mean" -v s="$spread" 'BEGIN { exit !(m > 0.05 && m < 0.98 && s > 0.01) }' || fail "the screenshot shows nothing: mean $mean, spread $spread"
# The command draws the same picture, but for what still streamed in: so it may take a few attempts.
reproduced() {
  local shot=$1
  local command
  command=$(identify -format '%[Command]' "$shot")
  eval "\"$skerry\" ${command#skerry } --out \"$work/again.png\"" 2>"$work/err2" || return 1
  local differing
  differing=$(compare -metric AE -fuzz 1% "$shot" "$work/again.png" null: 2>&1 || true)
  awk -v d="$differing" 'BEGIN { exit !(d <= 58) }'  # one pixel in a thousand
}
for attempt in 1 2 3 4 5 6; do
  reproduced "$(screenshots | tail -n 1)" && break
  [ "$attempt" -lt 6 ] || fail "the screenshot's command draws another picture"
  sleep 2
  key F2
  wait_for_screenshots $((attempt + 1))
done
identify -verbose "$first" | grep -q 'Command: skerry shot --seed 1 --camera' || fail "the screenshot does not hold its command"
grep -q '^skerry shot --seed 1 --camera ' "$work/out" || fail "the command was not printed"

# The overlay changes the window, not the screenshot's size; and goes away again.
grab "$work/plain.png"
key F3 1.5
grab "$work/overlay.png"
changed=$(compare -metric AE -fuzz 5% "$work/plain.png" "$work/overlay.png" null: 2>&1 || true)
awk -v c="$changed" 'BEGIN { exit !(c > 2000) }' || fail "F3 changed $changed pixels only"

# The calibration screen: its keys change what the picture's command says, and it goes away again.
key F3
key F9 1.5
grab "$work/calibration.png"
changed=$(compare -metric AE -fuzz 5% "$work/plain.png" "$work/calibration.png" null: 2>&1 || true)
awk -v c="$changed" 'BEGIN { exit !(c > 2000) }' || fail "F9 changed $changed pixels only"
for k in Up Up Up Down Left; do key "$k"; done
key F9
key Up
wait_until_quick  # a CPU driver makes programs that are used for the first time
before=$(screenshots | wc -l)
key F2
wait_for_screenshots $((before + 1))
command=$(identify -format '%[Command]' "$(screenshots | tail -n 1)")
case $command in
*display.peak=0.95*display.black=0.01*) ;;
*) fail "calibration is not in the command: $command" ;;
esac
key F3

for new in '500 300' '40 400' '1 1' '320 180'; do
  # shellcheck disable=SC2086  # two numbers
  xdotool windowsize "$window" $new
  sleep 1
  alive "after resizing to $new"
done
key F3

xdotool windowunmap "$window"
sleep 1
alive "while hidden"
xdotool windowmap "$window"
sleep 1
xdotool windowfocus "$window"
key Escape 1  # it paused when it lost the focus

for k in F8 F8 f bracketleft bracketright minus equal; do key "$k"; done
xdotool keydown w keydown t; sleep 3; xdotool keyup w keyup t
alive "while walking"
key F11 1
key F11 1
taken=$(screenshots | wc -l)
# On a slow machine it changes after the focus came, loses it with that, and has paused: which, is not to be seen from here.
plays_on() {
  xdotool windowfocus "$window"
  key F2 3
  has_screenshots $((taken + 1)) || { key Escape 1; return 1; }
}
until_true "it plays on after full screen" plays_on

quit
[ ! -s "$work/err" ] || fail "it complained"
echo "passed"
