#!/usr/bin/env python3
"""tools/check_tidy on a small repository: it finds what dangles, where it is asked to look."""
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
DANGLES = """#include <string>
#include <string_view>
struct Attribute { std::string_view value; };
std::string text();
int size() {
  const Attribute attribute{text()};
  return static_cast<int>(attribute.value.size());
}
"""
SOUND = "int one() {\n  return 1;\n}\n"


class CheckTidy(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name).resolve()
        self.write("tools/sound.cpp", SOUND)
        self.write("tools/dangles.cpp", DANGLES)
        for name in ("tools/check_tidy", ".clang-tidy"):
            shutil.copy(ROOT / name, self.root / name)
        commands = [{"directory": str(self.root), "file": str(self.root / name),
                     "command": f"c++ -std=c++20 -c {self.root / name}"}
                    for name in ("tools/sound.cpp", "tools/dangles.cpp")]
        self.write("build/tidy/compile_commands.json", json.dumps(commands))
        self.write(".gitignore", "/build/\n")
        for words in (["init", "--quiet"], ["add", "--all"], ["commit", "--quiet", "-m", "all"]):
            self.git(*words)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def git(self, *words):
        subprocess.run(["git", "-C", self.root, "-c", "user.name=a", "-c", "user.email=a@b", *words],
                       check=True, capture_output=True)

    def check(self, *arguments):
        done = subprocess.run([self.root / "tools" / "check_tidy", *arguments], capture_output=True,
                              text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_all_finds_what_dangles(self):
        status, said = self.check("--all")
        self.assertEqual(status, 1, said)
        self.assertIn("dangles.cpp:6", said)
        self.assertIn("2 sources, 1 with findings", said)

    def test_what_did_not_change_is_not_looked_at(self):
        self.write("tools/sound.cpp", SOUND + "\n")
        status, said = self.check("HEAD")
        self.assertEqual(status, 0, said)
        self.assertIn("1 sources, 0 with findings", said)

    def test_what_changed_is(self):
        self.write("tools/dangles.cpp", DANGLES + "\n")
        self.git("commit", "--quiet", "--all", "-m", "change")
        for arguments in (["HEAD^"], []):
            status, said = self.check(*arguments)
            self.assertEqual(status, 1, said)
            self.assertIn("dangling", said)

    def test_a_changed_header_is_looked_at_through_a_source(self):
        self.write("tools/dangles.h", "#pragma once\n")
        self.assertEqual(self.check("HEAD")[0], 1)

    def test_wrong_use_is_told(self):
        for arguments in (["no_such_commit"], ["--al"], ["HEAD", "HEAD"]):
            status, said = self.check(*arguments)
            self.assertEqual((status, said.count("\n")), (2, 1), said)


if __name__ == "__main__":
    if not shutil.which("clang-tidy-14") or not shutil.which("git"):
        print("skipped because there is no clang-tidy-14 or no git")
        sys.exit(77)
    unittest.main()
