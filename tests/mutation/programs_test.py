#!/usr/bin/env python3
"""tests/mutation/run --programs on folders that lack programs: one line before any is judged."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))
from mutants import MUTANTS


class Programs(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.programs = Path(self.scratch.name) / "programs"
        self.programs.mkdir()

    def tearDown(self):
        self.scratch.cleanup()

    def add(self, name, mode=0o755):
        """A program that leaves a mark when it is run."""
        (self.programs / name).write_text(f"#!/bin/sh\ntouch '{self.programs}/was_run'\n", encoding="utf-8")
        (self.programs / name).chmod(mode)

    def expect_refused(self, *words, only=()):
        chosen = [word for name in only for word in ("--only", name)]
        done = subprocess.run([HERE / "run", "--programs", self.programs, "--folder", f"{self.scratch.name}/work",
                               *chosen], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        for word in (str(self.programs), f"--build-only {self.programs}", *words):
            self.assertIn(word, done.stderr)
        self.assertFalse((self.programs / "was_run").exists(), "nothing is judged before all are found")

    def test_none_is_there(self):
        self.expect_refused(f"no program unmutated, {MUTANTS[0].id}", f"and {len(MUTANTS) - 4} more")

    def test_a_mutant_is_missing(self):
        for mutant in MUTANTS[:-1]:
            self.add(mutant.id)
        self.add("unmutated")
        self.expect_refused(f"no program {MUTANTS[-1].id} that")

    def test_the_unmutated_one_may_not_be_run(self):
        self.add(MUTANTS[0].id)
        self.add("unmutated", mode=0o644)
        self.expect_refused("no program unmutated that", only=[MUTANTS[0].id])


if __name__ == "__main__":
    unittest.main()
