#!/usr/bin/env bash
# Makes the .deb, looks into it, unpacks it into a folder and runs the program from there.
# usage: package_test.sh BUILD_FOLDER     exit: 0 passed, 1 failed, 77 no cpack or dpkg here
set -euo pipefail
build=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for tool in cpack dpkg-deb dpkg-shlibdeps; do command -v "$tool" >/dev/null || { echo "no $tool here"; exit 77; }; done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $1"; cat "$work/log" 2>/dev/null || true; exit 1; }

cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work/made" >"$work/log" 2>&1 || fail "cpack made no package"
package=$(find "$work/made" -maxdepth 1 -name 'skerry_*.deb')
[ -n "$package" ] || fail "there is no skerry_*.deb"
bytes=$(stat -c %s "$package")
echo "package_bytes $bytes"
[ "$bytes" -le 25000000 ] || fail "the package has $bytes bytes, over 25 MB"

field() { dpkg-deb --field "$package" "$1"; }
[ "$(field Package)" = skerry ] || fail "it is called $(field Package)"
[ "$(field Architecture)" = "$(dpkg --print-architecture)" ] || fail "it is for $(field Architecture)"
for needed in libc6 libglfw3 libvulkan1 libsqlite3-0 fonts-dejavu-core libxi6; do
  field Depends | grep -q "\b$needed\b" || fail "it does not depend on $needed: $(field Depends)"
done
field Recommends | grep -q 'mesa-vulkan-drivers' || fail "it recommends no Vulkan driver"
for font in microhei noto-cjk wqy-zenhei droid-fallback; do
  field Recommends | grep -q "[ |]fonts-[a-z-]*$font" || fail "it does not take $font for Chinese: $(field Recommends)"
done
# Each dependency is a package of this system: the names are right.
field Depends | tr ',' '\n' | sed 's/(.*//; s/|.*//; s/ //g' | while read -r name; do
  apt-cache show "$name" >/dev/null 2>&1 || dpkg-query --show "$name" >/dev/null 2>&1 || { echo "FAILED: there is no package $name"; exit 1; }
done || exit 1

dpkg-deb --contents "$package" | awk '{print $1, $2, $6}' >"$work/contents"
! grep -v '^[dl-]..[x-]..[x-]..[x-] root/root' "$work/contents" || fail "files that are not root's"
! awk '$1 ~ /^[-d].......w/ || $1 ~ /^[-d]....w/' "$work/contents" | grep . || fail "files that others may write"
root=$work/root
dpkg-deb --extract "$package" "$root"
# Folders may take another size on this disk.
installed=$(field Installed-Size) taken=$(du --apparent-size -sk "$root" | cut -f 1)
[ $((installed - taken)) -lt 200 ] && [ $((taken - installed)) -lt 200 ] || fail "it says that it takes $installed KiB, not $taken"
expected='usr/bin/skerry
usr/lib/skerry/skerry
usr/lib/skerry/skerry_openexr
usr/share/applications/org.skerry.Skerry.desktop
usr/share/doc/skerry/changelog.gz
usr/share/doc/skerry/copyright
usr/share/icons/hicolor/256x256/apps/org.skerry.Skerry.png
usr/share/man/man6/skerry.6.gz
usr/share/metainfo/org.skerry.Skerry.metainfo.xml'
[ ! -e "$build/skerry_openvdb" ] || expected="$expected
usr/lib/skerry/skerry_openvdb"
diff <(echo "$expected" | LC_ALL=C sort) <(cd "$root" && find . -type f -o -type l | sed 's|^\./||' | LC_ALL=C sort) || fail "other files than expected"
! file "$root/usr/lib/skerry/skerry" 2>/dev/null | grep -q 'not stripped' || fail "the program is not stripped"

# The desktop file names a program, an icon and a metainfo file that are there.
desktop=$root/usr/share/applications/org.skerry.Skerry.desktop
program=$(sed -n 's/^Exec=\([^ ]*\).*/\1/p' "$desktop")
[ -x "$root/usr/bin/$program" ] || fail "the desktop file starts '$program', which is not in the package"
[ -e "$root/usr/share/icons/hicolor/256x256/apps/$(sed -n 's/^Icon=//p' "$desktop").png" ] || fail "the icon of the desktop file is missing"
if command -v desktop-file-validate >/dev/null; then desktop-file-validate "$desktop" >"$work/log" || fail "the desktop file is invalid"; fi
if command -v appstreamcli >/dev/null; then
  # Later versions warn that the project has no page of its own, and fail with a warning.
  appstreamcli validate --no-net "$root"/usr/share/metainfo/*.xml >"$work/log" 2>&1 || true
  grep -q Validation "$work/log" || fail "the AppStream data was not read"
  ! grep '^[EW]:' "$work/log" | grep -v url-homepage-missing || fail "the AppStream data is invalid"
fi
if command -v lintian >/dev/null; then
  # Without a mail address and a place of its own for games; of later versions' opinions only errors count.
  lintian --fail-on error --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog,package-section-games-but-contains-no-game --allow-root "$package" >"$work/log" 2>&1 ||
    fail "lintian finds errors"
fi
if command -v man >/dev/null; then
  man --warnings -E UTF-8 -l "$root/usr/share/man/man6/skerry.6.gz" 2>"$work/log" >"$work/page" || fail "the man page does not read"
  [ ! -s "$work/log" ] || fail "the man page has mistakes"
  # It names every command of the program.
  "$root/usr/bin/skerry" --help | sed -n '/Subcommands:/,/^$/s/^  \([a-z]\{1,\}\) .*/\1/p' >"$work/commands"
  [ "$(wc -l <"$work/commands")" -ge 8 ] || fail "the commands could not be read"
  while read -r command; do grep -qw "$command" "$work/page" || fail "the man page leaves out '$command'"; done <"$work/commands"
fi

# The program, in its place: it draws, and finds its helper.
export XDG_DATA_HOME=$work/data XDG_CACHE_HOME=$work/cache XDG_CONFIG_HOME=$work/config
cd "$work"
[ "$("$root/usr/bin/skerry" --version)" = "skerry $(field Version)" ] || fail "its version is not that of the package"
"$root/usr/bin/skerry" devices >"$work/log" 2>&1 || fail "it lists no devices"
"$root/usr/bin/skerry" shot --seed 1 --size 64x36 --quality low --set view.distance=32 --out shot.png >"$work/log" 2>&1 || fail "it draws nothing"
[ -s shot.png ] || fail "there is no picture"
"$root/usr/bin/skerry" shot --seed 1 --size 64x36 --quality low --set view.distance=32 --ambient "$here/../scenes/evening.exr" --out exr.png >"$work/log" 2>&1 || fail "it does not find its reader of OpenEXR files"
if [ -e "$root/usr/lib/skerry/skerry_openvdb" ]; then
  "$root/usr/bin/skerry" vdb info "$here/../scenes/islet.vdb" >"$work/log" 2>&1 || fail "it does not find its helper"
fi
echo "passed"
