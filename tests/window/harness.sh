# Sourced by the tests of this folder: a display and folders of one's own, and the game in a window there.
# Sets `skerry`, `work` (a temporary folder) and, once play was called, `game` (its process) and `window`.
set -euo pipefail

work=$(mktemp -d)
server= game= window=
cleanup() {
  [ -z "$game" ] || kill "$game" 2>/dev/null || true
  [ -z "$server" ] || kill "$server" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap cleanup EXIT
fail() {  # on stderr: it may be called where the output is taken for a value
  echo "FAILED: $1" >&2
  cat "$work/out" "$work/err" >&2 2>/dev/null || true
  exit 1
}
alive() { kill -0 "$game" 2>/dev/null || fail "the game ended $1"; }
key() { xdotool key --window 0 "$1"; sleep "${2:-$key_pause}"; alive "after $1"; }

# start_display TOOL...: ends the test as skipped if a tool is missing.
start_display() {
  local tool
  for tool in Xvfb xdotool "$@"; do
    command -v "$tool" >/dev/null || { echo "no $tool here"; exit 77; }
  done
  # -displayfd lets the server choose a free display number.
  Xvfb -displayfd 3 -noreset -screen 0 800x600x24 -nolisten tcp 3>"$work/display" >/dev/null 2>&1 &
  server=$!
  for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
  [ -s "$work/display" ] || fail "Xvfb did not start"
  DISPLAY=:$(cat "$work/display")
  export DISPLAY XDG_DATA_HOME="$work/data" XDG_CACHE_HOME="$work/cache" XDG_CONFIG_HOME="$work/config"
  unset WAYLAND_DISPLAY
}

# A window manager, and sets `manager` to its process. Windows that are opened while it starts are never shown.
start_manager() {
  openbox >/dev/null 2>&1 &
  manager=$!
  for _ in $(seq 100); do xdotool get_desktop >/dev/null 2>&1 && return; sleep 0.1; done
  fail "openbox did not start"
}

# play OPTION...: under the validation layer; waits for the window and gives it the focus.
quality=(--quality low)
play() {
  "$skerry" play --size 320x180 "${quality[@]}" --validate "$@" >"$work/out" 2>"$work/err" &
  game=$!
  for _ in $(seq 300); do
    alive "while opening its window"
    window=$(xdotool search --pid "$game" --onlyvisible 2>/dev/null | head -n 1) && [ -n "$window" ] && break
    sleep 0.2
  done
  [ -n "$window" ] || fail "no window appeared"
  # Without a window manager nobody else hands out the focus.
  xdotool windowfocus "$window"
}

# The title names the frame rate once frames of a world are drawn.
wait_for_frames() {
  for _ in $(seq 300); do
    alive "before it drew"
    xdotool getwindowname "$window" | grep -q fps && break
    sleep 0.2
  done
}

# Whether there is no world in the window yet: to the right it has the colour that stands for one (game/ui/look.h), while programs are
# compiled and behind a title that comes first.
loading() { [ "$(import -silent -window "$window" -crop 1x1+300+2 -depth 8 rgb:- | od -An -tu1 | xargs)" = "16 26 32" ]; }
loaded() { ! loading; }

fps() { xdotool getwindowname "$window" | sed 's/.* \([0-9]*\) fps/\1/'; }
# Shaders are compiled and the world is there: until then frames are few, and what the mouse does in one of them counts as a whole.
wait_until_quick() {
  for _ in $(seq 300); do [ "$(fps)" -ge 5 ] && break; sleep 0.3; alive "before it was quick"; done
  sleep 2
}

# The game must end by itself and well.
expect_end() {
  for _ in $(seq 100); do kill -0 "$game" 2>/dev/null || break; sleep 0.2; done
  kill -0 "$game" 2>/dev/null && fail "it did not quit"
  local status=0
  wait "$game" || status=$?
  game=
  [ "$status" -eq 0 ] || fail "it exited with $status"
}

# Quits as a player does: Escape pauses, and the pause's last button quits.
quit() {
  key Escape 1
  for _ in 1 2 3 4 5 6 7 8 9; do key Down 0.3; done
  xdotool key Return
  expect_end
}
