#!/bin/sh
# Draws tests/scenes_of_files, whose .vdb files are other people's and no part of this repository. They
# are looked for in the folder SKERRY_FILES, else in shared/vdb beside the sources; without that
# folder the test is skipped.
#   scenes_of_files_test.sh SKERRY FOLDER [option of skerry test]...     FOLDER gets the pictures
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
skerry=$1 folder=$2
shift 2
files=${SKERRY_FILES:-$root/../shared/vdb}
if ! [ -d "$files" ]; then
  echo "skipped: there is no folder $files; tests/scenes_of_files/README.md says what it should hold"
  exit 77
fi
SKERRY_FILES=$files exec "$skerry" test "$root/tests/scenes_of_files" --validate --html "$folder" "$@"
