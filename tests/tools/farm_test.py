#!/usr/bin/env python3
"""Runs `plan`, `run` and `merge` of `skerry test`, `report` and `stability`, ends them at random.

    farm_test.py SKERRY_PROGRAM FOLDER [KILLS]      FOLDER is made anew; 6 kills in long runs, else 2,
                                                    and fewer scenes

However the tasks of a plan are split over folders, what is merged has the same bytes; a run that
is killed loses no row and doubles none; what is missing, contradicts itself, or comes from another
device is said.
"""
import json
import os
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

from commands_test import SKY, Runs, check

ROWS = 10_000
MERGE_SECONDS = 3.0
LONG = "SKERRY_LONG_TESTS" in os.environ
SCENES = {f"sky_{hour:02}": {"time": f"{hour}:00"} for hour in range(8, 17 if LONG else 14)}


def rows_of(folder):
    return {file.stem: json.loads(file.read_text(encoding="utf-8"))
            for file in (folder / "rows").glob("*.json")}


def write_row(folder, row):
    (folder / "rows").mkdir(exist_ok=True)
    (folder / "rows" / f"{row['task']}.json").write_text(json.dumps(row), encoding="utf-8")


def names_of(folder):
    return [task["name"] for task in json.loads((folder / "plan.json").read_text())["tasks"]]


def same_bytes(a, b):
    """Whether two files, or all files below two folders, have the same names and bytes."""
    if a.is_file():
        return a.read_bytes() == b.read_bytes()
    names = sorted(path.relative_to(a) for path in a.rglob("*"))
    return (names == sorted(path.relative_to(b) for path in b.rglob("*"))
            and all((a / name).read_bytes() == (b / name).read_bytes()
                    for name in names if (a / name).is_file()))


def copy_plan(plan, folder):
    folder.mkdir(parents=True)
    shutil.copy(plan / "plan.json", folder)
    return folder


def split_ways(names):
    """Lists of the TASK arguments of several `run`: three shares, names dealt at random, or either."""
    dealt = [[] for _ in range(4)]
    for name in names:
        random.choice(dealt).append(name)
    ways = {"random": [part for part in dealt if part],
            "thirds": [[f"{i}/3"] for i in (1, 2, 3)]}
    return ways if LONG else dict([random.choice(list(ways.items()))])


class Work:
    """A plan that has been run in one folder, and what its merge writes."""

    def __init__(self, run, folder, command, arguments, outputs):
        self.run, self.folder, self.command, self.outputs = run, folder, command, outputs
        self.whole = folder / "whole"
        run(command, "plan", *arguments, "--dir", self.whole)
        run(command, "run", "--dir", self.whole)
        self.merged = self.merge("merged", [self.whole])

    def merge(self, name, folders, status=0):
        """Merges folders, the first of which has the plan. @return the folder of the outputs."""
        out = self.folder / name
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir()
        options = [word for option, file in self.outputs.items() for word in (option, out / file)]
        self.run(self.command, "merge", *folders[1:], "--dir", folders[0], *options, status=status)
        return out

    def check_splits(self):
        for way, parts in split_ways(names_of(self.whole)).items():
            folders = [copy_plan(self.whole, self.folder / way / str(i))
                       for i in range(len(parts))]
            for folder, tasks in zip(folders, parts):
                self.run(self.command, "run", *tasks, "--dir", folder)
            rows = {}
            for folder in folders:
                for task, row in rows_of(folder).items():
                    check(task not in rows, f"{way}: {task} ran twice")
                    rows[task] = row
            expected = rows_of(self.whole)
            check(rows.keys() == expected.keys(), f"{way}: other tasks ran")
            # Times differ from run to run and nothing else does.
            for folder in folders:
                for task, row in rows_of(folder).items():
                    check(row["result"] == expected[task]["result"],
                          f"{way}: {row} is not {expected[task]}")
                    write_row(folder, row | {"measured": expected[task]["measured"]})
            random.shuffle(folders)
            check(same_bytes(self.merged, self.merge(f"merged_{way}", folders)),
                  f"{self.command}: split as {way}, the merge differs")

    def check_faults(self):
        task, row = next(iter(rows_of(self.whole).items()))
        other = copy_plan(self.whole, self.folder / "other")
        write_row(other, row | {"measured": {}})
        if self.command != "report":  # whose measurements are on the page
            self.merge("twice_alike", [self.whole, other])
        result = row["result"]
        unlike = result * 2 if isinstance(result, list) else result | {"unlike": True}
        write_row(other, row | {"result": unlike})
        done = self.run(self.command, "merge", other, "--dir", self.whole,
                        *self.place("twice_unlike"), status=1)
        check("ran twice with different results" in done.stdout + done.stderr, done)
        if row["device"]:
            write_row(other, row | {"device": "another device"})
            done = self.run(self.command, "merge", other, "--dir", self.whole,
                            *self.place("devices"), status=1)
            check("different devices" in done.stderr, done)
        (other / "rows" / f"{task}.json").write_text("{", encoding="utf-8")
        done = self.run(self.command, "merge", other, "--dir", self.whole,
                        *self.place("damaged"), status=1)
        check("delete the file and run its task again" in done.stderr, done)
        shutil.rmtree(other)
        missing = self.whole / "rows" / f"{task}.json"
        kept = missing.rename(self.folder / "kept.json")
        done = self.run(self.command, "merge", "--dir", self.whole, *self.place("missing"),
                        status=1)
        check(done.stdout.count("it has no row") == 1, done)
        kept.rename(missing)

    def place(self, name):
        return ["--out", self.folder / name] if self.command == "report" else []


def check_kills(work, kills):
    """Kills runs of all tasks at random moments until the tasks are done."""
    folder = copy_plan(work.whole, work.folder / "killed")
    expected = rows_of(work.whole)
    start = time.monotonic()
    work.run(work.command, "run", "--dir", copy_plan(work.whole, work.folder / "timed"))
    seconds = time.monotonic() - start
    for _ in range(kills):
        with subprocess.Popen([work.run.program, work.command, "run", "--dir", folder],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            time.sleep(random.uniform(0.0, 1.1 * seconds))
            process.kill()
        for task, row in rows_of(folder).items():
            check(row["result"] == expected[task]["result"], f"{row} after a kill")
        if random.random() < 0.5 and rows_of(folder):  # so that there is something left to run
            random.choice(list((folder / "rows").iterdir())).unlink()
    work.run(work.command, "run", "--dir", folder)
    check(rows_of(folder).keys() == expected.keys(), "a row was lost")
    for row in rows_of(folder).values():
        write_row(folder, row | {"measured": expected[row["task"]]["measured"]})
    check(same_bytes(work.merged, work.merge("merged_killed", [folder])), "after kills it differs")


def check_changes(work, scenes):
    """What a task depends on has changed: its rows are not made under the old name."""
    scene = scenes / "sky_08.json"
    before = scene.read_bytes()
    scene.write_text(json.dumps(SKY | {"fov": 99}), encoding="utf-8")
    done = work.run("test", "run", "sky_09", "--dir", work.whole, status=1)
    check("'sky_08' is not what was planned" in done.stderr, done)
    scene.write_bytes(before)
    work.run("test", "run", "sky_09", "--dir", work.whole)
    done = work.run("test", "run", "sky_9", "--dir", work.whole, status=2)
    check("did you mean 'sky_09'" in done.stderr, done)
    done = work.run("report", "run", "--dir", work.whole, status=1)
    check("it is one of skerry" in done.stderr, done)
    other = work.folder / "skerry"
    other.write_bytes(Path(work.run.program).read_bytes() + b"0")
    other.chmod(0o755)
    done = Runs(other)("test", "run", "sky_09", "--dir", work.whole, status=1)
    check("is not what was planned" in done.stderr, done)


def check_devices(work):
    """All devices of this machine, which may be one, give the rows that one gives."""
    folder = copy_plan(work.whole, work.folder / "all_devices")
    work.run(work.command, "run", "--devices", "all", "--dir", folder)
    expected = rows_of(work.whole)
    rows = rows_of(folder)
    check(rows.keys() == expected.keys(), "--devices all left tasks out")
    for task, row in rows.items():
        for key in ("device", "driver", "result"):
            check(row[key] == expected[task][key], f"{row} is not {expected[task]}")
    work.run(work.command, "run", "--devices", "two", "--dir", folder, status=2)


def check_farm(work):
    """What `farm` does where there is no Slurm; tests/slurm has the rest."""
    folder = copy_plan(work.whole, work.folder / "it's 100% for farm")
    script = work.run("farm", "submit", folder, "--tasks-per-job", 4, "--constraint", "alike",
                      "--dry-run").stdout
    check(not (folder / "jobs").exists(), "--dry-run wrote something")
    tasks = names_of(folder)
    jobs = (len(tasks) + 3) // 4
    check(f'--array="1{f"-{jobs}" if jobs > 1 else ""}"' in script, script)
    check(("--exclusive" in script) == (work.command == "report"), script)
    for job in range(1, jobs + 1):  # as Slurm would: a shell that has the job's number
        array = script.split("\n\n")[0]
        subprocess.run(["sh", "-c", array], check=True, stdout=subprocess.DEVNULL,
                       env=os.environ | {"SLURM_ARRAY_TASK_ID": str(job)})
    check(rows_of(folder).keys() == rows_of(work.whole).keys(), "jobs left tasks out")
    check("have rows" in work.run("farm", "status", folder).stdout, "status")
    work.run("farm", "fetch", folder, "--to", work.folder / "fetched")
    check(rows_of(work.folder / "fetched") == rows_of(folder), "fetch left rows out")
    check((work.folder / "fetched" / "page" / "index.html").exists(), "fetch did not merge")
    next((folder / "rows").iterdir()).unlink()
    path = os.environ["PATH"]
    os.environ["PATH"] = str(folder)
    done = work.run("farm", "submit", folder, "--constraint", "alike", status=1)
    os.environ["PATH"] = path
    check("cannot run 'sbatch'" in done.stderr and done.stderr.count("\n") == 1, done)
    done = work.run("farm", "status", folder)
    check(" 1 not submitted" in done.stdout, done)
    work.run("farm", "submit", work.folder, "--dry-run", status=1)
    if work.command == "report":
        done = work.run("farm", "submit", folder, "--dry-run", status=2)
        check("nodes of one kind" in done.stderr, done)


def check_references(work, arguments):
    """References are computed once for all that share their folder."""
    def references():
        return {file.name: file.stat().st_mtime_ns
                for file in (work.whole / "references").iterdir()}
    before = references()
    check(before and all(name.endswith(".reference") for name in before), before)
    work.run("report", *arguments, "--references", work.whole / "references", "--out",
             work.folder / "by_kept_references")
    shared = copy_plan(work.whole, work.folder / "shared")
    work.run("report", "run", "--references", work.whole / "references", "--dir", shared)
    check(references() == before, f"references were made again: {references()} after {before}")
    for task, row in rows_of(shared).items():
        check(row["result"] == rows_of(work.whole)[task]["result"], f"{row} by a kept reference")


def check_many(work):
    """A merge of many rows takes seconds."""
    folder = work.folder / "many"
    folder.mkdir()
    plan = json.loads((work.whole / "plan.json").read_text(encoding="utf-8"))
    row = next(iter(rows_of(work.whole).values()))
    plan["tasks"] = [{"id": f"t{i:024x}", "name": f"scene {i:05}"} for i in range(ROWS)]
    (folder / "plan.json").write_text(json.dumps(plan), encoding="utf-8")
    for task in plan["tasks"]:
        write_row(folder, row | {"task": task["id"]})
    start = time.monotonic()
    out = work.merge("merged_many", [folder])
    seconds = time.monotonic() - start
    print(f"{ROWS} rows merged in {seconds:.2f} s")
    check(seconds <= MERGE_SECONDS or os.getloadavg()[0] > os.cpu_count(),
          f"a merge of {ROWS} rows took {seconds:.1f} s, more than {MERGE_SECONDS}")
    check(len(json.loads((out / "rows.json").read_text(encoding="utf-8"))["rows"]) == ROWS,
          "rows are missing")


def main(program, folder, kills="6" if LONG else "2"):
    folder = Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    scenes = folder / "scenes"
    scenes.mkdir(parents=True)
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    run = Runs(program)
    for name, more in SCENES.items():
        (scenes / f"{name}.json").write_text(json.dumps(SKY | more), encoding="utf-8")
    run("test", scenes, "--approve")
    (folder / "test").mkdir()
    work = Work(run, folder / "test", "test", [scenes],
                {"--html": "page", "--json": "rows.json", "--junit": "rows.xml"})
    work.check_splits()
    work.check_faults()
    check_kills(work, int(kills))
    check_changes(work, scenes)
    check_devices(work)
    check_farm(work)
    check_many(work)

    cases = ["projection.near_and_far", "projection.fields_of_view", "exposure.steps",
             "time.islands"]
    (folder / "stability").mkdir()
    work = Work(run, folder / "stability", "stability", cases, {"--json": "rows.json"})
    work.check_splits()
    work.check_faults()
    run("stability", *cases, "--json", folder / "at_once.json")
    check(same_bytes(folder / "at_once.json", work.merged / "rows.json"),
          "stability at once and in parts differ")

    (folder / "report").mkdir()
    arguments = ["bloom_levels", "lights_oracle", "--size", "24x16", "--set",
                 "reference.samples=1", "--set", "view.distance=48"]
    work = Work(run, folder / "report", "report", arguments, {"--out": "page"})
    work.check_splits()
    work.check_faults()
    check_devices(work)
    check_farm(work)
    check_references(work, arguments)


if __name__ == "__main__":
    main(*sys.argv[1:])
