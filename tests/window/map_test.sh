#!/usr/bin/env bash
# The map, a waypoint and the way home, under Xvfb, with the keyboard alone.
# usage: map_test.sh SKERRY_PROGRAM     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or ImageMagick here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
key_pause=0.6
start_display convert identify compare
play --seed 1 --set view.distance=200
xdotool windowsize "$window" 640 360
wait_for_frames
wait_until_quick

grab() { import -silent -window "$window" "$1"; }
shots() { { find "$work/data/skerry/screenshots" -name '*.png' 2>/dev/null || true; } | wc -l; }
has_shots() { [ "$(shots)" -ge "$1" ]; }
# X,Y,Z of the camera now.
camera() {
  local before
  before=$(shots)
  key F2
  until_true "a screenshot is saved" has_shots $((before + 1))
  grep -o -- '--camera [^ ]*' "$work/out" | tail -n 1 | cut -d ' ' -f 2
}
# Blocks between two cameras.
apart() { awk -v a="$1" -v b="$2" 'BEGIN { split(a, p, ","); split(b, q, ","); for (i = 1; i <= 3; ++i) s += (p[i] - q[i]) ^ 2; print sqrt(s) }'; }
near() { awk -v d="$(apart "$1" "$2")" -v most="$3" 'BEGIN { exit !(d < most) }'; }

key p  # the day stands still
spawn=$(camera)
# Walks off with a waypoint where it ends.
xdotool keydown s; sleep 3; xdotool keyup s; sleep 1
away=$(camera)
near "$spawn" "$away" 0.5 && fail "it did not walk: $spawn, then $away"
key b

# The map shows land, at every scale another picture: many colours in its square, and none before it opened.
grab "$work/world.png"
key m 1
differs() { [ "$(compare -metric AE -fuzz 10% "$1" "$2" null: 2>&1 || true)" -gt 2000 ]; }
# The upper part of the map: messages lie over the lower one.
square() { grab "$work/now.png" && convert "$work/now.png" -crop 240x160+50+60 +repage "$1"; }
drawn() {
  square "$work/map.png"
  [ "$(convert "$work/map.png" -format '%k' info:)" -gt 300 ]
}
until_true "the map is drawn" drawn
sleep 2
square "$work/wide.png"
key Up 0.3
key Up 0.3  # some ImGui starts at the first button, some at the slider
cp "$work/now.png" "${SKERRY_KEEP:-$work}/map.png"
# The keys that walk move it, and its own brings it back.
xdotool keydown d; sleep 1; xdotool keyup d; sleep 1
square "$work/moved.png"
differs "$work/wide.png" "$work/moved.png" || fail "the map does not move"
key m 1.5
square "$work/back.png"
differs "$work/wide.png" "$work/back.png" && fail "the map does not come back to the player"
key Escape 1
grab "$work/again.png"
convert "$work/again.png" -crop 240x160+50+60 +repage "$work/closed.png"
differs "$work/wide.png" "$work/closed.png" || fail "the map did not close"

# Home, by its key; and back to the waypoint, by the map: the list begins with home, the ground stood on last, the waypoint.
key Home 1
near "$(camera)" "$spawn" 1.5 || fail "Home did not lead home: $(camera), not $spawn"
key m 2
xdotool key --window 0 Return  # the first button: go to what is chosen, home
sleep 1
key Escape 1
near "$(camera)" "$spawn" 1.5 || fail "the map's first place is not home"

quit
[ ! -s "$work/err" ] || fail "it complained"
echo "passed"
