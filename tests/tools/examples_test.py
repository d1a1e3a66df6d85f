#!/usr/bin/env python3
"""Runs the commands of the CI examples in docs/examples, on a few scenes that are drawn in a moment.

    examples_test.py SKERRY_PROGRAM FOLDER      FOLDER is made anew

Scripts of the repository are not run; they have to be there. The pages and tables that an example
keeps have to be there afterwards.
"""
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from commands_test import SKY, Runs, check

SOURCES = Path(__file__).resolve().parent.parent.parent
PARTS = 4
# Of each example: what it keeps.
KEPT = {"github-actions.yml": ["pictures/index.html", "pictures.xml"],
        "gitlab-ci.yml": ["part1.json", "part4/index.html", "pictures/index.html", "pictures.xml"]}


def commands_of(text):
    """`- run: COMMAND`, and the lists under `script:`."""
    found, indent = [], None
    for line in text.splitlines():
        stripped = line.strip()
        depth = len(line) - len(line.lstrip())
        if stripped == "script:":
            indent = depth
        elif indent is not None and stripped.startswith("- ") and depth > indent:
            found.append(stripped[2:])
        else:
            indent = None
            if match := re.fullmatch(r"- run: (.+)", stripped):
                found.append(match[1])
    return found


def run_example(example, work):
    commands = commands_of(example.read_text(encoding="utf-8"))
    check(sum("skerry" in command for command in commands) > 0, f"{example} runs no skerry")
    for command in commands:
        program = command.split()[0]
        if program != "build/release/skerry":
            check(os.access(SOURCES / program, os.X_OK), f"{example}: there is no {program}")
            continue
        parts = PARTS if "CI_NODE" in command else 1
        for index in range(1, parts + 1):
            node = {"CI_NODE_INDEX": str(index), "CI_NODE_TOTAL": str(parts)}
            done = subprocess.run(["bash", "-c", command], cwd=work, env=os.environ | node,
                                  capture_output=True, text=True, check=False)
            check(done.returncode == 0, f"{example}: {command}: {done.stdout}{done.stderr}")
    for name in KEPT[example.name]:
        check((work / name).exists(), f"{example} makes no {name}")


def main(program, folder):
    folder = Path(folder).resolve()
    program = Path(program).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    examples = sorted((SOURCES / "docs/examples").iterdir())
    check([example.name for example in examples] == sorted(KEPT), examples)
    for example in examples:
        work = folder / example.stem
        scenes = work / "tests/scenes"
        scenes.mkdir(parents=True)
        (work / "build/release").mkdir(parents=True)
        (work / "build/release/skerry").symlink_to(program)
        for hour in range(9, 9 + PARTS):
            (scenes / f"{hour}.json").write_text(json.dumps(SKY | {"time": f"{hour}:00"}),
                                                 encoding="utf-8")
        Runs(program)("test", scenes, "--approve")
        run_example(example, work)


if __name__ == "__main__":
    main(*sys.argv[1:])
