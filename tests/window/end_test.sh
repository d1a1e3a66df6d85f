#!/usr/bin/env bash
# A signal ends a play whose world has just been dug in, and a full disk is told on stderr.
# usage: end_test.sh SKERRY_PROGRAM     exit: 0 passed, 1 failed, 77 no Xvfb, xdotool, python3 or OpenVDB here
source "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
skerry=$1
key_pause=0.5
start_display python3

islet=$(dirname "${BASH_SOURCE[0]}")/../scenes/islet.vdb
"$skerry" vdb import "$islet" --out "$work/world" >/dev/null 2>&1 || { echo "no OpenVDB here"; exit 77; }
chunks() { python3 -c 'import hashlib, sqlite3, sys
rows = sqlite3.connect(sys.argv[1]).execute("SELECT island, x, y, z, data FROM chunk ORDER BY 1, 2, 3, 4").fetchall()
print(hashlib.sha256(repr(rows).encode()).hexdigest())' "$1"; }

# Looks down and holds the button, so that blocks go one after another.
dig_on() {
  for _ in 1 2 3 4 5 6 7 8; do xdotool mousemove_relative -- 0 75; sleep 0.3; done
  xdotool mousedown 1
  sleep 8
}
# end_by SIGNAL STATUS: the save has two seconds (docs/saving.md), the end of the process as long again; a busy machine notices later.
end_by() {
  local status=0 sent=${EPOCHREALTIME/./} took_ms
  kill "-$1" "$game"
  for _ in $(seq 200); do kill -0 "$game" 2>/dev/null || break; sleep 0.05; done
  took_ms=$(((${EPOCHREALTIME/./} - sent) / 1000))
  kill -0 "$game" 2>/dev/null && fail "it goes on after SIG$1"
  [ "$took_ms" -lt 8000 ] || fail "SIG$1 ended it after $took_ms ms, not within 4000 and as many more"
  wait "$game" || status=$?
  game=
  [ "$status" -eq "$2" ] || fail "SIG$1 ended it with status $status, not $2"
}

before=$(chunks "$work/world")
play --world "$work/world" --set view.distance=64
wait_for_frames
# Its own name, and no seed: it has none.
title=$(xdotool getwindowname "$window")
[[ $title =~ ^'Skerry - '(world|islet)' - '[0-9]+' fps'$ ]] || fail "the title names another world: $title"
wait_until_quick
dig_on
end_by TERM 143
[ ! -s "$work/err" ] || fail "it complained"
[ "$(chunks "$work/world")" != "$before" ] || fail "what was dug is lost"

# A disk of its own, as large as the world and a little.
if [ "$(id -u)" -eq 0 ] && mkdir "$work/disk" && mount -t tmpfs -o size=400k none "$work/disk" 2>/dev/null; then
  trap 'umount -l "$work/disk"; cleanup' EXIT
  cp "$work/world" "$work/disk/world"
  play --world "$work/disk/world" --set view.distance=64
  wait_until_quick
  head -c 1M /dev/zero >"$work/disk/filler" 2>/dev/null || true
  dig_on
  until_true "a full disk is told on stderr" grep -q '^skerry: warning: cannot save' "$work/err"
  end_by TERM 1
fi
echo "passed"
