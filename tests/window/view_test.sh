#!/usr/bin/env bash
# Under a window manager: nothing but the mouse turns the view, losing the focus pauses, and quality set by keys is kept.
# usage: view_test.sh SKERRY_PROGRAM     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or openbox here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
key_pause=0.7
start_display openbox
start_manager
trap 'kill "$manager" 2>/dev/null || true; cleanup' EXIT
sleep 1

play --seed 1 --time 12:00 --set view.distance=48
wait_for_frames
wait_until_quick

cameras() { { grep -o -- '--camera [^ ]*' "$work/out" || true; } | cut -d ' ' -f 2; }
# Takes a screenshot; prints yaw and pitch.
direction() {
  screenshot "$1"
  cameras | tail -n 1 | cut -d , -f 4,5
}
expect_same() {  # to a hundredth of a degree: what is taken back is rounded
  awk -v a="$2" -v b="$3" 'BEGIN { split(a, p, ","); split(b, q, ","); d = (p[1] - q[1]) ^ 2 + (p[2] - q[2]) ^ 2; exit !(d < 1e-4) }' ||
    fail "the view turned from $2 to $3 by $1"
}

# The mouse does turn it; of the settling after the window's first focus the test waits until it is over.
for _ in 1 2 3 4; do xdotool mousemove_relative -- 20 5; sleep 0.3; done
start=$(direction "at the start")
xdotool mousemove_relative -- 40 0
sleep 1
turned=$(direction "after the mouse moved")
[ "$start" != "$turned" ] || fail "the mouse does not turn the view"

# After a screen that keys alone went through, the mouse turns it by no more than the mouse moves.
key Escape 1
key Escape 1
xdotool mousemove_relative -- 8 0
sleep 1
after=$(direction "after a pause")
awk -v a="$turned" -v b="$after" 'BEGIN { split(a, p, ","); split(b, q, ","); exit !((p[1] - q[1]) ^ 2 < 4 && (p[2] - q[2]) ^ 2 < 1e-4) }' ||
  fail "the view turned from $turned to $after by 8 pixels of the mouse after a pause"
turned=$after

for size in '500 300' '200 400' '1 1' '640 360' '64 64' '320 180'; do
  # shellcheck disable=SC2086  # two numbers
  xdotool windowsize "$window" $size
  sleep 0.5
done
for i in $(seq 12); do xdotool windowsize "$window" $((300 + 20 * i)) $((180 + 9 * i)); done
xdotool windowsize "$window" 320 180
sleep 1
expect_same "resizing" "$turned" "$(direction "after resizing")"

for place in '10 10' '300 200' '0 0' '100 50'; do
  # shellcheck disable=SC2086
  xdotool windowmove "$window" $place
  sleep 0.4
done
expect_same "moving the window" "$turned" "$(direction "after moving")"

key F11 1.5
key F11 1.5
xdotool windowactivate "$window"
sleep 1
expect_same "fullscreen and back" "$turned" "$(direction "after F11")"

# Iconified it has no focus and pauses; a screenshot is none of the pause's keys.
xdotool windowminimize "$window"
sleep 1.5
alive "while iconified"
xdotool windowactivate "$window"
sleep 1.5
before=$(commands)
key F2 2
[ "$(commands)" = "$before" ] || fail "it did not pause when it lost the focus"
key Escape 1
expect_same "iconifying" "$turned" "$(direction "after iconifying")"

# Quality by a key is kept, once the window is closed.
key equal
xdotool key --window 0 alt+F4
await_end  # it may wait for programs of that quality
grep -q '"quality": "medium"' "$work/config/skerry/settings.json" || fail "the quality set by a key is forgotten"
echo "passed"
