#!/usr/bin/env bash
# With a gamepad alone, under Xvfb: types a seed, makes a world, walks, takes a picture, pauses, is unplugged, and quits.
# usage: pad_test.sh SKERRY_PROGRAM VIRTUAL_PAD_LIBRARY     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or ImageMagick here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
library=$2
start_display convert compare

"$skerry" shot --seed 1 --size 320x180 --quality low --set view.distance=64 --out "$work/warm.png" 2>"$work/err" || fail "no picture"

export SKERRY_TEST_PAD=$work/pad
# hold LINE...: what is pressed from now on; returns once a frame has seen it. A frame may be slow.
state=0
hold() {
  state=$((state + 1))
  printf '%s\n' "$@" "state $state" >"$work/pad.new"
  mv "$work/pad.new" "$work/pad"
  [ -n "$game" ] || return 0
  for _ in $(seq 600); do
    [ "$(cat "$work/pad.read" 2>/dev/null)" != "$state" ] || return 0
    kill -0 "$game" 2>/dev/null || return 0  # the press may have ended it
    sleep 0.02
  done
  fail "no frame reads the gamepad"
}
rest() { hold; }
press() {  # BUTTON...: together, the first of them longest
  hold "button $1"
  [ $# -eq 1 ] || { hold "button $1" "button $2"; sleep 0.3; }
  rest
  sleep 0.1
  alive "after button $*"
}
readonly A=0 B=1 X=2 BACK=6 START=7 UP=11 RIGHT=12 DOWN=13 LEFT=14
rest
LD_PRELOAD=$library play --set view.distance=64
grab() { import -silent -window "$window" "$1"; }
moves() {
  grab "$work/then.png"
  sleep 1
  grab "$work/now.png"
  [ "$(compare -metric AE -fuzz 2% "$work/then.png" "$work/now.png" null: 2>&1 || true)" -gt 200 ]
}
until_true "the island behind the title turns" moves
until_true "it is loaded" loaded
until_true "the island behind the title goes on" moves

press $A  # new world
sleep 1
# A slow frame repeats a way, so the steps are not counted: down to the last row, right to Delete, where the seed that was drawn goes,
# left and up to letters of the first column; up again over others of it until Create: worlds are few so, and there is room to walk.
for _ in $(seq 12); do press $DOWN; done
for _ in $(seq 6); do press $RIGHT; done
for _ in $(seq 24); do press $A; done
for _ in $(seq 8); do press $LEFT; done
press $UP
for _ in 1 2 3; do press $A; done
for _ in $(seq 8); do
  press $UP
  press $A
  for _ in 1 2 3 4 5; do playing && break 2; sleep 0.3; done
done
until_true "a world is played" playing
world=$(find "$work/data/skerry/worlds" -name '*.skerry' -printf '%f\n')
[[ $world =~ ^World_[zaq1]{3,}\.skerry$ ]] || fail "the seed is not what was typed: $world"
sleep 4

# A line for each picture: world time and camera.
places() { sed -n 's/^skerry shot.*--camera \([^ ]*\).*world\.time=\([0-9.]*\).*/\2 \1/p' "$work/out"; }
has_places() { [ "$(places | wc -l)" -ge "$1" ]; }
take_picture() {
  local before
  before=$(places | wc -l)
  press $BACK $X
  until_true "a picture is taken" has_places $((before + 1))
}
# Blocks from where the drift of the island, seen in pictures A and B at rest, would have carried the player between C and D.
walked() {
  places | awk -v a="$1" -v b="$2" -v c="$3" -v d="$4" '{ split($2, p, ","); t[NR] = $1; for (i = 1; i <= 3; ++i) x[NR, i] = p[i] }
    END { for (i = 1; i <= 3; ++i) s += (x[d, i] - x[c, i] - (x[b, i] - x[a, i]) / (t[b] - t[a]) * (t[d] - t[c])) ^ 2; print sqrt(s) }'
}
take_picture
sleep 1
take_picture
hold "axis 1 -1"
sleep 0.7  # an island may be small
rest
take_picture
awk -v d="$(walked 1 2 2 3)" 'BEGIN { exit !(d > 0.7) }' || fail "the stick does not walk: $(walked 1 2 2 3) blocks"

# Unplugged while it walks: it stands.
hold "axis 1 1"
sleep 0.5
rm "$work/pad"
sleep 1
alive "after the pad was unplugged"
rest
sleep 0.5
take_picture
sleep 1
take_picture
awk -v d="$(walked 1 2 4 5)" 'BEGIN { exit !(d < 0.5) }' || fail "it walks on without a pad: $(walked 1 2 4 5) blocks"

press $START
press $B  # back to the world
press $START
for _ in 1 2 3 4 5 6 7 8; do press $DOWN; done
hold "button $A"
rest
expect_end
[ ! -s "$work/err" ] || fail "it complained"
echo "passed"
