#!/usr/bin/env bash
# Starts with empty caches under Xvfb, so that a CPU driver compiles programs for seconds: the window lives meanwhile, keys are kept
# and the mouse does nothing. Any validation message fails it.
# usage: loading_test.sh SKERRY_PROGRAM     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or ImageMagick here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
key_pause=0.1
start_display identify import compare
start_manager

loads() { ! xdotool getwindowname "$window" | grep -q fps; }
mkdir -p "$work/data"
screenshots() { find "$work/data" -name '*.png' | sort; }
has_more_screenshots() { [ "$(screenshots | wc -l)" -gt "$1" ]; }
screenshot_command() {
  local before
  before=$(screenshots | wc -l)
  key F2
  until_true "a screenshot is saved" has_more_screenshots "$before"
  identify -format '%[Command]\n' "$(screenshots | tail -n 1)"
}
yaw_and_pitch() { sed 's/.*--camera \([^ ]*\).*/\1/' <<<"$1" | cut -d, -f4,5; }

play --seed 1 --set view.distance=200
sleep 1
# Motion and clicks that mean nothing, then keys that do: twice a nearer view.
xdotool mousemove --window "$window" 100 90
for _ in $(seq 5); do xdotool mousemove_relative -- 20 5 click 3; sleep 0.05; done
key bracketleft
key bracketleft
# Something moves on the screen while it loads.
import -silent -window "$window" "$work/one.png"
changed=0
for _ in $(seq 20); do
  sleep 0.3
  import -silent -window "$window" "$work/two.png"
  loads || break
  changed=$(compare -metric AE -fuzz 5% "$work/one.png" "$work/two.png" null: 2>&1 || true)
  awk -v c="$changed" 'BEGIN { exit !(c > 10) }' && break
done
loaded_long=no
if loads; then
  awk -v c="$changed" 'BEGIN { exit !(c > 10) }' || fail "nothing moved while it loaded"
  sleep 2
  loads && loaded_long=yes  # so it did when the mouse moved
fi
wait_for_frames
wait_until_quick
first=$(screenshot_command)
case $first in
*view.distance=128*) ;;
*) fail "keys that were pressed while it loaded are lost: $first" ;;
esac
kill "$game"
wait "$game" || true
[ ! -s "$work/err" ] || fail "it complained"

# Where the world begins, untouched, and with programs that were compiled before.
play --seed 1 --set view.distance=200
wait_for_frames
wait_until_quick
second=$(screenshot_command)
if [ $loaded_long = yes ]; then
  [ "$(yaw_and_pitch "$first")" = "$(yaw_and_pitch "$second")" ] ||
    fail "the mouse turned the view while it loaded: $first, not $second"
fi
quit
[ ! -s "$work/err" ] || fail "it complained"

# The title comes first, long before what is behind it: its first button is the first that is seen.
rm -rf "$XDG_CACHE_HOME"
began=${EPOCHREALTIME/./}
play
for _ in $(seq 200); do
  import -silent -window "$window" "$work/title.png"
  [ "$(convert "$work/title.png" -format '%k' info:)" -gt 1 ] && break
  alive "before its title"
done
echo "title_ms $(((${EPOCHREALTIME/./} - began) / 1000))"
# The colour of that button, 0.3 of (122, 204, 190), over (16, 26, 32) or darker.
convert "$work/title.png" -depth 8 rgb:- | od -An -v -w3 -tu1 |
  awk '$1 > 36 && $1 < 60 && $2 > 60 && $2 < 90 && $3 > 56 && $3 < 90 { n++ } END { exit !(n > 300) }' ||
  fail "the title's button is not the first that is seen"
until_true "its title is drawn" loaded
sleep 1
[ ! -s "$work/err" ] || fail "it complained"
kill "$game"
wait "$game" || true
game=
echo "passed; loaded long enough to move the mouse: $loaded_long"
