#!/usr/bin/env bash
# With a gamepad alone, under Xvfb: types a seed, makes a world, walks, takes a picture, pauses, is unplugged, and quits.
# usage: pad_test.sh SKERRY_PROGRAM VIRTUAL_PAD_LIBRARY     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or ImageMagick here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
library=$2
start_display convert compare

"$skerry" shot --seed 1 --size 320x180 --quality low --set view.distance=64 --out "$work/warm.png" 2>"$work/err" || fail "no picture"

export SKERRY_TEST_PAD=$work/pad
hold() { printf '%s\n' "$@" >"$work/pad.new"; mv "$work/pad.new" "$work/pad"; }
rest() { : >"$work/pad.new"; mv "$work/pad.new" "$work/pad"; }
press() {  # BUTTON...: together, the first of them longest
  hold "button $1"; sleep 0.13  # longer, and the way would be gone again
  [ $# -eq 1 ] || { hold "button $1" "button $2"; sleep 0.3; }
  rest; sleep 0.5
  alive "after button $*"
}
readonly A=0 B=1 X=2 BACK=6 START=7 UP=11 RIGHT=12 DOWN=13
rest
LD_PRELOAD=$library play --set view.distance=64
grab() { import -silent -window "$window" "$1"; }
until_true() {
  for _ in $(seq 200); do "${@:2}" && return; sleep 0.2; alive "while waiting until $1"; done
  fail "it never came to be that $1"
}
moves() {
  grab "$work/then.png"
  sleep 1
  grab "$work/now.png"
  [ "$(compare -metric AE -fuzz 2% "$work/then.png" "$work/now.png" null: 2>&1 || true)" -gt 200 ]
}
until_true "the island behind the title turns" moves
until_true "the island behind the title goes on" moves

press $A  # new world
sleep 6
# A slow frame repeats a way, so the steps are not counted: down to the last row, up to letters, up again until Create.
for _ in $(seq 12); do press $DOWN; done
press $UP
for _ in 1 2 3; do press $A; press $RIGHT; done
playing() { xdotool getwindowname "$window" | grep -q fps; }
for _ in $(seq 8); do
  press $UP
  press $A
  for _ in 1 2 3 4 5; do playing && break 2; sleep 0.3; done
done
until_true "a world is played" playing
world=$(find "$work/data/skerry/worlds" -name '*.skerry' -printf '%f\n')
[[ $world =~ ^World_[0-9]+[a-z][0-9a-z_]*\.skerry$ ]] || fail "the letters are not in the seed: $world"
sleep 4

cameras() { { grep -o -- '--camera [^ ]*' "$work/out" || true; } | cut -d ' ' -f 2; }
has_cameras() { [ "$(cameras | wc -l)" -ge "$1" ]; }
press $BACK $X
until_true "a picture is taken" has_cameras 1
hold "axis 1 -1"
sleep 2
rest
press $BACK $X
until_true "another picture is taken" has_cameras 2
awk -v a="$(cameras | head -n 1)" -v b="$(cameras | tail -n 1)" 'BEGIN { split(a, p, ","); split(b, q, ",");
  for (i = 1; i <= 3; ++i) s += (p[i] - q[i]) ^ 2; exit !(sqrt(s) > 0.3) }' || fail "the stick does not walk"

# Unplugged while it walks: it stands.
hold "axis 1 -1"
sleep 0.5
rm "$work/pad"
sleep 1
alive "after the pad was unplugged"
rest
sleep 0.5
press $BACK $X
until_true "a third picture is taken" has_cameras 3
sleep 1
press $BACK $X
until_true "a fourth picture is taken" has_cameras 4
awk -v a="$(cameras | tail -n 2 | head -n 1)" -v b="$(cameras | tail -n 1)" 'BEGIN { split(a, p, ","); split(b, q, ",");
  for (i = 1; i <= 3; ++i) s += (p[i] - q[i]) ^ 2; exit !(sqrt(s) < 0.5) }' || fail "it walks on without a pad"

press $START
press $B  # back to the world
press $START
for _ in 1 2 3 4 5 6; do press $DOWN; done
press $A
expect_end
[ ! -s "$work/err" ] || fail "it complained"
echo "passed"
