#!/usr/bin/env bash
# How well frames are drawn, in a window under Xvfb and a window manager: quality is chosen, and what it was chosen by is kept.
# usage: quality_test.sh SKERRY_PROGRAM     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool or openbox here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
key_pause=0.5
start_display openbox python3
start_manager
trap 'kill "$manager" 2>/dev/null || true; cleanup' EXIT
learnt=$work/cache/skerry/quality.json

# Quality is chosen, what it was chosen by is kept, and what was asked for by name stays.
mkdir -p "$work/cache/skerry"
echo '{"version": 1, "machines": [' >"$learnt"
quality=()
play --seed 1 --set view.distance=100
wait_for_frames
sleep 40
screenshot
case $command in *view.distance=100*) ;; *) fail "the view distance that was named is gone: $command" ;; esac
quit
[ "$(grep -c . "$work/err")" = 1 ] && grep -q 'quality.json is damaged' "$work/err" || fail "it did not tell of the damaged file alone"
python3 - "$learnt" <<'P' || fail "what was learnt was not kept: $(cat "$learnt")"
import json, sys
machine, = json.load(open(sys.argv[1]))["machines"]
assert machine["machine"].endswith("320x180") and len(machine["costs_ms"]) >= 2, machine
P
echo "passed"
