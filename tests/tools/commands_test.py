#!/usr/bin/env python3
"""Runs `skerry test`, `report` and `stability` on little, and looks at the pages they write.

    commands_test.py SKERRY_PROGRAM FOLDER      FOLDER is made anew

Under the sanitizers (tools/sanitize) the program ends itself at the first wrong access; a run in
which it does is a failure here.
"""
import json
import os
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

from page_links import faults_of, read_page

# Names as short as a string that needs no memory of its own, longer, and with what a URL has not.
SCENES = {"a": {}, "a_name_that_is_longer_than_any_small_string": {"fov": 30},
          "two words & 100%": {"fov": 120}}
SKY = {"size": "48x27", "time": "16:00", "settings": {"world.islands": 0}}


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


class Runs:
    def __init__(self, program):
        self.program = program

    def __call__(self, *arguments, status=0):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True,
                              text=True, errors="replace", check=False)
        check(done.returncode == status and "Sanitizer" not in done.stderr
              and "runtime error" not in done.stderr,
              f"{arguments}: status {done.returncode}, not {status}: {done.stdout}{done.stderr}")
        return done


def check_page(folder, ids):
    """Every link of the page has its target, and every one of `ids` is linked to."""
    page = folder / "index.html"
    faults = faults_of(page)
    check(not faults, faults)
    read = read_page(page)
    check(len(read.ids) == ids, f"{page} has {len(read.ids)} ids, not {ids}")
    linked = [link for link in read.links if link.startswith("#")]
    check(len(set(linked)) == ids, f"{page} has {len(set(linked))} links to {ids} parts")


def write_scenes(folder):
    folder.mkdir()
    for name, more in SCENES.items():
        (folder / f"{name}.json").write_text(json.dumps(SKY | more), encoding="utf-8")


def check_test(run, folder):
    scenes = folder / "scenes"
    write_scenes(scenes)
    run("test", scenes, "--approve", "--html", folder / "approved")
    check_page(folder / "approved", len(SCENES))
    (scenes / "a.json").write_text(json.dumps(SKY | {"fov": 100}), encoding="utf-8")
    run("test", scenes, "--html", folder / "failed", "--json", folder / "rows.json",
        "--junit", folder / "rows.xml", status=1)
    check_page(folder / "failed", len(SCENES))
    check(len(read_page(folder / "failed" / "index.html").sources) >= 6, "a failure shows pictures")
    for index in (1, 2):
        run("test", scenes, "--shard", f"{index}/2", "--json", folder / f"{index}.json", "--html",
            folder / f"html{index}", status=1 if index == 1 else 0)
    run("test", "--merge", folder / "1.json", folder / "2.json", "--html", folder / "merged",
        status=1)
    check_page(folder / "merged", len(SCENES))


def check_archive(run, folder):
    """References in a tar archive, which Python reads as well."""
    scenes, archive = folder / "scenes", folder / "baseline.tar"
    run("test", scenes, "--baseline", archive, status=2)
    run("test", scenes, "--baseline", archive, "--approve")
    with tarfile.open(archive) as tar:
        names = [name for name in tar.getnames() if name.endswith("a.png")]
    check(names and not any(file.is_dir() for file in folder.glob("*baseline*")), names)
    run("test", scenes, "--baseline", archive)
    (scenes / "a.json").write_text(json.dumps(SKY | {"fov": 20}), encoding="utf-8")
    done = run("test", scenes, "--baseline", archive, status=1)
    check("is the first to differ" in done.stdout, done)
    run("test", "plan", scenes, "--baseline", archive, "--dir", folder / "plan")
    run("test", "run", "--dir", folder / "plan")
    run("test", "merge", "--dir", folder / "plan", status=1)
    archive.write_bytes(archive.read_bytes()[:2000])
    done = run("test", scenes, "--baseline", archive, status=2)
    check("Truncated" in done.stderr and done.stderr.count("\n") == 1, done)


def check_report(run, folder):
    out = folder / "report"
    run("report", "water_layers", "lights_oracle", "--size", "24x16", "--set",
        "reference.samples=1", "--set", "view.distance=48", "--out", out)
    check_page(out, 2)


def check_stability(run, folder):
    file = folder / "stability.json"
    run("stability", "--json", file, "exposure", "time.islands", "finite.bloom", "media.slab",
        "shadows.directions", "projection.near_and_far")
    rows = json.loads(file.read_text(encoding="utf-8"))["rows"]
    check(len(rows) > 10 and all(row["pass"] for row in rows), rows)


def main(program, folder):
    folder = Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    # Pictures of drivers that no one approved, and pipelines that no one else needs.
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    run = Runs(program)
    for part in (check_test, check_archive, check_report, check_stability):
        part(run, folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
