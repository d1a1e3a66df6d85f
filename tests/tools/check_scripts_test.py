#!/usr/bin/env python3
"""tools/check_includes and tools/check_paths against small trees that keep or break one rule each."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parent.parent.parent / "tools"

# A tree that keeps every rule; each test changes one file of it.
GOOD = {
    "engine/core/log.h": "#include <string>\n",
    "engine/gpu/device/device.h": '#include <volk.h>\n#include "engine/core/log.h"\n',
    "engine/render/sky.h": '#include "engine/gpu/device/device.h"\n#include "shaders/shared/types.h"\n',
    "shaders/shared/types.h": "// docs/conventions.md\n#include <glm/vec3.hpp>\n",
    "shaders/include/light/light.glsl": '#include "types.h"\n',
    "shaders/surface/shade.comp": '#include "include/light/light.glsl"\n',
    "world/voxel/chunk.h": '#include "engine/core/log.h"\n',
    "world/voxel/chunk.cpp": '#include "world/voxel/chunk.h"\n\n#include <vector>\n',
    "world/vdb/read_vdb.cpp": "#include <openvdb/openvdb.h>\n",
    "game/session/session.h": '#include "world/voxel/chunk.h"\n',
    "game/session/session_state.h": '#include "game/session/session.h"\n',
    "game/session/session.cpp": '#include "game/session/session.h"\n\n#include "game/session/session_state.h"\n',
    "game/client/app.h": '#include "game/session/session.h"\n#include "engine/render/sky.h"\n',
    "tools/skerry/main.cpp": '#include "tools/skerry/shot/shot.h"\n',
    "tools/skerry/shot/shot.h": '#include "game/client/app.h"\n',
    "tests/world/chunk_test.cpp": '#include "tools/skerry/shot/shot.h"\n#include "world/voxel/chunk.h"\n',
}


def run(script, files):
    """Runs a script on a tree; returns its exit status and what it printed."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = Path(root, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, TOOLS / script, root], capture_output=True, text=True)
        return done.returncode, done.stdout


class CheckIncludes(unittest.TestCase):
    def assert_breach(self, name, text, says):
        status, output = run("check_includes", {**GOOD, name: text})
        self.assertEqual(status, 1, output)
        self.assertEqual(len(output.splitlines()), 1, output)
        self.assertTrue(output.startswith(name + ": "), output)
        self.assertIn(says, output)

    def test_a_tree_that_keeps_the_rules_passes(self):
        status, output = run("check_includes", GOOD)
        self.assertEqual((status, output), (0, f"{len(GOOD)} files keep the include table\n"))

    def test_an_empty_tree_is_not_taken_for_a_good_one(self):
        self.assertEqual(run("check_includes", {})[0], 1)

    def test_each_room_is_kept_from_each_room_above_it(self):
        above = {
            "shaders/shared": "engine/core/log.h",
            "engine/core": "world/voxel/chunk.h",
            "engine/gpu": "shaders/shared/types.h",
            "engine/platform": "engine/gpu/device/device.h",
            "engine/render": "world/voxel/chunk.h",
            "world": "engine/gpu/device/device.h",
            "game": "tools/skerry/shot/shot.h",
            "game/session": "engine/render/sky.h",
            "tools/skerry": "tests/world/fixture.h",
        }
        for room, header in above.items():
            with self.subTest(room=room):
                files = {**GOOD, header: GOOD.get(header, ""), f"{room}/extra.h": f'#include "{header}"\n'}
                status, output = run("check_includes", files)
                self.assertEqual(status, 1)
                self.assertIn(f"{room}/extra.h: ", output)

    def test_vulkan_stays_in_the_rooms_that_draw(self):
        self.assert_breach("world/light.h", "#include <vulkan/vulkan.h>\n", "Vulkan")
        self.assert_breach("engine/platform/files.h", "#  include <volk.h>\n", "Vulkan")
        status, output = run("check_includes", {**GOOD, "engine/platform/window.h": "#include <volk.h>\n"})
        self.assertEqual(status, 0, output)

    def test_openvdb_stays_in_the_sources_of_world_vdb(self):
        self.assert_breach("world/vdb/grid.h", "#include <openvdb/openvdb.h>\n", "OpenVDB")

    def test_shared_headers_use_the_standard_library_and_maths_only(self):
        self.assert_breach("shaders/shared/quad.h", "#include <fmt/format.h>\n", "standard library")

    def test_a_source_includes_its_own_header_first(self):
        self.assert_breach("world/voxel/chunk.cpp", '#include <vector>\n\n#include "world/voxel/chunk.h"\n', "own header")

    def test_includes_are_written_from_the_root(self):
        self.assert_breach("world/voxel/island.h", '#include "chunk.h"\n', "no file")

    def test_units_do_not_include_each_other(self):
        files = {**GOOD, "world/voxel/a.h": '#include "world/voxel/b.h"\n', "world/voxel/b.h": "",
                 "world/voxel/b.cpp": '#include "world/voxel/b.h"\n#include "world/voxel/a.h"\n'}
        status, output = run("check_includes", files)
        self.assertEqual(status, 1)
        self.assertEqual(output, "units that include each other: world/voxel/a, world/voxel/b\n")

    def test_folders_do_not_include_each_other(self):
        files = {**GOOD, "world/mesh/a.h": '#include "world/voxel/b.h"\n', "world/voxel/b.h": "",
                 "world/voxel/c.h": '#include "world/mesh/d.h"\n', "world/mesh/d.h": ""}
        status, output = run("check_includes", files)
        self.assertEqual(status, 1)
        self.assertEqual(output, "folders that include each other: world/mesh, world/voxel\n")

    def test_folders_of_shaders_do_not_include_each_other(self):
        files = {**GOOD, "shaders/include/light/shadow.glsl": '#include "include/sky/sky.glsl"\n',
                 "shaders/include/sky/sky.glsl": "",
                 "shaders/include/sky/march.glsl": '#include "include/light/light.glsl"\n'}
        status, output = run("check_includes", files)
        self.assertEqual(status, 1)
        self.assertEqual(output, "folders that include each other: shaders/include/light, shaders/include/sky\n")

    def test_the_state_of_a_unit_is_its_own(self):
        self.assert_breach("game/session/other.cpp", '#include "game/session/session_state.h"\n', "private")

    def test_a_folder_holds_so_many_files(self):
        most = {f"world/many/a{i}.h": "" for i in range(30)}
        self.assertEqual(run("check_includes", {**GOOD, **most})[0], 0)
        status, output = run("check_includes", {**GOOD, **most, "world/many/b.h": ""})
        self.assertEqual((status, output), (1, "world/many: 31 files; split what holds more than 30\n"))

    def test_an_include_in_a_comment_does_not_count(self):
        text = '// #include "game/session/session.h"\n/*\n#include <volk.h>\n*/\n'
        status, output = run("check_includes", {**GOOD, "world/a.h": text})
        self.assertEqual(status, 0, output)

    def test_a_shader_leads_to_the_conventions(self):
        self.assert_breach("shaders/post/blur.comp", "void main() {}\n", "docs/conventions.md")


class CheckPaths(unittest.TestCase):
    def test_paths_of_a_developers_machine_are_found(self):
        # Put together here, or this file would be found itself.
        for folder in ("work", "tmp", "root"):
            with self.subTest(folder=folder):
                status, output = run("check_paths", {"a/b.txt": f"first\nsee '/{folder}/c' for more\n"})
                self.assertEqual((status, output), (1, f"a/b.txt:2: see '/{folder}/c' for more\n"))

    def test_relative_paths_and_other_words_are_left_alone(self):
        text = "build/tmp/x ${dir}/work/y ../home/z /usr/share /tmpfs /workbench and/or /worker\n"
        status, output = run("check_paths", {"a.txt": text})
        self.assertEqual(status, 0, output)

    def test_a_picture_is_skipped_without_an_error(self):
        with tempfile.TemporaryDirectory() as root:
            Path(root, "a.png").write_bytes(b"\x89PNG\xff\xfe")
            Path(root, "b.txt").write_text("text\n")
            done = subprocess.run([sys.executable, TOOLS / "check_paths", root], capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_text_of_a_picture_is_read(self):
        text = b"Command\0skerry shot --world /" + b"tmp/a.vdb"
        chunk = len(text).to_bytes(4, "big") + b"tEXt" + text + b"crc_"
        with tempfile.TemporaryDirectory() as root:
            Path(root, "a.png").write_bytes(b"\x89PNG\r\n\x1a\n" + chunk)
            done = subprocess.run([sys.executable, TOOLS / "check_paths", root], capture_output=True,
                                  text=True)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn("a.png:1: ", done.stdout)


if __name__ == "__main__":
    unittest.main()
