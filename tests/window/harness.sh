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
# until_true WHAT COMMAND...: waits until the command comes true. The limit is for a machine that is slow and busy; where it is not, nothing is lost.
until_true() {
  local limit=$((SECONDS + 180))
  until "${@:2}"; do
    [ -z "$game" ] || alive "while waiting until $1"
    [ $SECONDS -lt $limit ] || fail "it never came to be that $1"
    sleep 0.2
  done
}
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
  until_true "Xvfb has started" test -s "$work/display"
  DISPLAY=:$(cat "$work/display")
  export DISPLAY XDG_DATA_HOME="$work/data" XDG_CACHE_HOME="$work/cache" XDG_CONFIG_HOME="$work/config"
  unset WAYLAND_DISPLAY
}

# A window manager, and sets `manager` to its process. Windows that are opened while it starts are never shown.
start_manager() {
  openbox >/dev/null 2>&1 &
  manager=$!
  until_true "openbox has started" manages_windows
}
manages_windows() { xdotool get_desktop >/dev/null 2>&1; }

# play OPTION...: in long runs and where a test says so under the validation layer, with which programs take twice as long; waits for the window and gives it the focus.
quality=(--quality low)
validation=(${SKERRY_LONG_TESTS:+--validate})
play() {
  "$skerry" play --size 320x180 "${quality[@]}" "${validation[@]}" "$@" >"$work/out" 2>"$work/err" &
  game=$!
  until_true "a window appears" find_window
  # Without a window manager nobody else hands out the focus.
  xdotool windowfocus "$window"
}

find_window() { window=$(xdotool search --pid "$game" --onlyvisible 2>/dev/null | head -n 1) && [ -n "$window" ]; }

# The title names the frame rate once frames of a world are drawn.
playing() { xdotool getwindowname "$window" | grep -q fps; }
wait_for_frames() { until_true "a world is drawn" playing; }

# Whether there is no world in the window yet: to the right it has the colour that stands for one (game/ui/look.h), while programs are
# compiled and behind a title that comes first.
loading() { [ "$(import -silent -window "$window" -crop 1x1+300+2 -depth 8 rgb:- | od -An -tu1 | xargs)" = "16 26 32" ]; }
loaded() { ! loading; }

fps() { xdotool getwindowname "$window" | sed 's/.* \([0-9]*\) fps/\1/'; }
# Shaders are compiled and the world is there: until then frames are few, and what the mouse does in one of them counts as a whole.
wait_until_quick() {
  local limit=$((SECONDS + 90))  # some machines never are
  until [ "$(fps)" -ge 5 ] 2>/dev/null || [ $SECONDS -ge $limit ]; do sleep 0.3; alive "before it was quick"; done
  sleep 2
}

# @return whether the game ends within so many seconds.
ends_within() {
  local limit=$((SECONDS + $1))
  while kill -0 "$game" 2>/dev/null; do
    [ $SECONDS -lt $limit ] || return 1
    sleep 0.2
  done
}

await_end() { ends_within 180 || fail "it did not quit"; }

# The game must end by itself and well.
expect_end() {
  local status=0
  await_end
  wait "$game" || status=$?
  game=
  [ "$status" -eq 0 ] || fail "it exited with $status"
}

# Quits as a player does: Escape pauses, and the pause's last button quits. A window that lost the focus meanwhile has paused by itself, and Escape
# went on: then once more.
quit() {
  for _ in 1 2 3; do
    key Escape 1
    for _ in 1 2 3 4 5 6 7 8 9; do key Down 0.3; done
    xdotool key Return
    ends_within 30 && break
  done
  expect_end
}

commands() { grep -c '^skerry shot' "$work/out" || true; }
has_more_commands() { [ "$(commands)" -gt "$1" ]; }
# Sets `command` to the command line of a new screenshot. @param which it is, for messages.
screenshot() {
  local before
  before=$(commands)
  xdotool key --window 0 F2
  until_true "a screenshot is taken ${1-}" has_more_commands "$before"
  command=$(grep '^skerry shot' "$work/out" | tail -n 1)
}
