#!/usr/bin/env bash
# How often frames are drawn, in a window under Xvfb and a window manager: seldom where nobody looks, caps hold, and time played is time passed.
# usage: frames_test.sh SKERRY_PROGRAM     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool, openbox or ImageMagick here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
key_pause=0.5
start_display openbox display
start_manager
other=
trap 'kill "$manager" ${other:+"$other"} 2>/dev/null || true; cleanup' EXIT
learnt=$work/cache/skerry/quality.json

# Processor seconds that the game takes in so many seconds.
spent() { awk '{ print ($14 + $15) / 100 }' "/proc/$game/stat"; }
spent_in() {
  local before
  before=$(spent)
  sleep "$1"
  alive "while its time was measured"
  awk -v a="$before" -v b="$(spent)" 'BEGIN { print b - a }'
}

# A named level learns nothing.
quality=(--quality low)
play --seed 1 --set view.distance=100 --set frames.cap=off --set frames.unfocused=1
wait_for_frames
wait_until_quick
case $(screenshot; echo "$command") in *'--quality low'*) ;; *) fail "low is not low: $command" ;; esac

# Waits until the game takes less than a share of what playing takes; programs that no view has needed yet may still be compiled, for a minute
# or more.
takes_less() {
  local took
  for _ in $(seq 45); do
    took=$(spent_in 4)
    awk -v a="$playing" -v b="$took" -v s="$1" 'BEGIN { exit !(b < s * a) }' && return
  done
  fail "it takes $took s of 4 $2, $playing s while it is played"
}

# Frames come as fast as they can, seldom without the focus, and not at all without a window or behind a screen.
playing=$(spent_in 4)
display -size 40x40 xc:red &
other=$!
sleep 2
takes_less 0.4 "without the focus"
kill "$other"
other=
xdotool windowactivate "$window"
sleep 2
xdotool windowminimize "$window"
takes_less 0.4 minimised
xdotool windowactivate "$window"
sleep 2
xdotool windowfocus "$window"
key Escape 1  # losing the focus has paused
playing=$(spent_in 4)
key Escape 1
takes_less 0.7 paused
key Escape 1

# Islands have moved on by the time that has passed, though a frame took more than a second.
world_time() { sed 's/.*world.time=\([0-9.]*\).*/\1/' <<<"$command"; }
screenshot
began=$(date +%s.%N) first=$(world_time)
sleep 1
kill -STOP "$game"
sleep 1.3
kill -CONT "$game"
sleep 1
screenshot
awk -v a="$first" -v b="$(world_time)" -v s="$began" -v e="$(date +%s.%N)" \
  'BEGIN { played = b - a; passed = e - s; exit !(played > 3 && played < passed + 0.5 && played > passed - 1) }' ||
  fail "from world time $first to $(world_time) in $(awk -v s="$began" -v e="$(date +%s.%N)" 'BEGIN { print e - s }') s"
quit
[ ! -e "$learnt" ] || fail "a named level learnt something"

# A cap holds, and every way to wait for the display starts.
for sync in on adaptive; do
  play --seed 1 --set view.distance=100 --set frames.cap=10 --set frames.sync=$sync
  wait_for_frames
  wait_until_quick
  [ "$(fps)" -le 10 ] || fail "capped at 10 it draws $(fps) frames a second"
  quit
done
[ ! -s "$work/err" ] || fail "it complained"
echo "passed"
