#!/usr/bin/env bash
# Plays in a window under Xvfb, as a person would: keys, screenshot, resizing, minimising, quitting. Any validation message fails it.
# usage: play_test.sh SKERRY_PROGRAM     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or ImageMagick here
set -euo pipefail
skerry=$1
for tool in Xvfb xdotool convert identify; do
  command -v "$tool" >/dev/null || { echo "no $tool here"; exit 77; }
done

work=$(mktemp -d)
server= game=
cleanup() {
  [ -z "$game" ] || kill "$game" 2>/dev/null || true
  [ -z "$server" ] || kill "$server" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap cleanup EXIT
fail() {
  echo "FAILED: $1"
  cat "$work/out" "$work/err" 2>/dev/null || true
  exit 1
}

# -displayfd lets the server choose a free display number.
Xvfb -displayfd 3 -screen 0 800x600x24 -nolisten tcp 3>"$work/display" >/dev/null 2>&1 &
server=$!
for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || fail "Xvfb did not start"
DISPLAY=:$(cat "$work/display")
export DISPLAY XDG_DATA_HOME="$work/data" XDG_CACHE_HOME="$work/cache"
unset WAYLAND_DISPLAY

"$skerry" play --seed 1 --size 320x180 --quality low --set view.distance=200 --validate >"$work/out" 2>"$work/err" &
game=$!
alive() { kill -0 "$game" 2>/dev/null || fail "the game ended $1"; }

window=
for _ in $(seq 300); do
  alive "while opening its window"
  window=$(xdotool search --pid "$game" --onlyvisible 2>/dev/null | head -n 1) && [ -n "$window" ] && break
  sleep 0.2
done
[ -n "$window" ] || fail "no window appeared"
# Without a window manager nobody else hands out the focus.
xdotool windowfocus "$window"
key() { xdotool key --window 0 "$1"; sleep "${2:-0.5}"; alive "after $1"; }
# The title names the frame rate once frames are drawn.
for _ in $(seq 300); do
  alive "before it drew"
  xdotool getwindowname "$window" | grep -q fps && break
  sleep 0.2
done
xdotool getwindowname "$window" | grep -q 'seed 1' || fail "the title does not name the seed"
sleep 3

screenshots() { find "$work/data" -name '*.png' 2>/dev/null | sort; }
wait_for_screenshots() {
  for _ in $(seq 100); do [ "$(screenshots | wc -l)" -ge "$1" ] && return; sleep 0.2; alive "while taking a screenshot"; done
  fail "screenshot $1 did not come"
}
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

for k in F8 F8 f bracketleft bracketright minus equal; do key "$k"; done
xdotool keydown w keydown t; sleep 3; xdotool keyup w keyup t
alive "while walking"
key F11 1
key F11 1
xdotool windowfocus "$window"
taken=$(screenshots | wc -l)
key F2
wait_for_screenshots $((taken + 1))

# Escape pauses; the last button of the pause quits.
key Escape 1
for _ in 1 2 3 4 5 6 7; do key Down; done
xdotool key Return
for _ in $(seq 100); do kill -0 "$game" 2>/dev/null || break; sleep 0.2; done
kill -0 "$game" 2>/dev/null && fail "it did not quit"
status=0
wait "$game" || status=$?
game=
[ "$status" -eq 0 ] || fail "it exited with $status"
[ ! -s "$work/err" ] || fail "it complained"
echo "passed"
