#!/usr/bin/env python3
"""Runs a test set under Slurm on four nodes of this machine, and takes a node and the controller away.

    slurm_test.py SKERRY_PROGRAM FOLDER [KILLS]      FOLDER is made anew

Exit status 77, with the reason, where tests/slurm/cluster cannot make a cluster. All rows come,
each once, and the page that is merged has the bytes of the one made without Slurm. With KILLS, so
many tasks, nodes and controllers are ended at random as well, and the disk is full for a while:
100 take ten minutes.
"""
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tools"))
from commands_test import SKY, check  # noqa: E402
from farm_test import rows_of, same_bytes, write_row  # noqa: E402

SCENES = 12
NODES = ("n1", "n2", "n3", "n4")
SECONDS = 90.0  # for all jobs to end
RUNS = 30  # of each scene, so that a job takes long enough for its node to be lost


class Cluster:
    def __init__(self, folder, program):
        self.folder, self.program = folder, program

    def call(self, command, *arguments):
        done = subprocess.run([HERE / "cluster", command, self.folder, *map(str, arguments)],
                              capture_output=True, text=True, check=False)
        check(done.returncode == 0, f"cluster {command} {arguments}: {done.stdout}{done.stderr}")
        return done.stdout

    def skerry(self, *arguments, status=0):
        """Runs skerry where users of the cluster log in."""
        done = subprocess.run([HERE / "cluster", "run", self.folder, self.program,
                               *map(str, arguments)], capture_output=True, text=True, check=False)
        check(done.returncode == status,
              f"{arguments}: status {done.returncode}, not {status}: {done.stdout}{done.stderr}")
        return done

    def running(self):
        """{node: job} of the jobs on nodes."""
        lines = self.call("run", "squeue", "--noheader", "--array", "--states=R",
                          "--format=%N %F_%K").splitlines()
        return dict(line.split() for line in lines)


def wait_until(what, holds):
    end = time.monotonic() + SECONDS
    while not holds():
        check(time.monotonic() < end, f"{what} took more than {SECONDS} s")
        time.sleep(0.3)


def processes_with(word):
    """Ids of the processes that have a word in their command line."""
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if word in (folder / "cmdline").read_bytes().decode().split("\0"):
                yield int(folder.name)
        except OSError:
            pass  # it has ended


def job_of(process):
    """(node, job) of a process that Slurm started; none if it has ended."""
    try:
        lines = (Path("/proc") / str(process) / "environ").read_bytes().decode().split("\0")
    except OSError:
        return None
    of = dict(line.split("=", 1) for line in lines if "=" in line)
    if "SLURMD_NODENAME" not in of or "SLURM_ARRAY_TASK_ID" not in of:
        return None
    return of["SLURMD_NODENAME"], f"{of['SLURM_ARRAY_JOB_ID']}_{of['SLURM_ARRAY_TASK_ID']}"


def lose_a_node(cluster, plan):
    """Kills a node that runs a task. @return the job, which the dead node cannot have ended: its
    process is stopped first, however quick tasks are."""
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        for process in processes_with(str(plan)):
            found = job_of(process)
            if not found:
                continue
            try:
                os.kill(process, signal.SIGSTOP)
            except ProcessLookupError:
                continue
            node, job = found
            if cluster.running().get(node) == job:
                cluster.call("kill", node)
                return job
            os.kill(process, signal.SIGCONT)
    sys.exit("FAILED: no node was lost while it ran a job")


def check_errors(cluster, plan):
    """What is said in one line."""
    for arguments, says in ((["--time", "never"], "sbatch failed: "),
                            (["--partition", "nowhere"], "sbatch failed: "),
                            (["--constraint", "purple"], "sbatch failed: ")):
        done = cluster.skerry("farm", "submit", plan, *arguments, status=1)
        check(says in done.stderr and done.stderr.count("\n") == 1, done)
    check(not (plan / "jobs" / "submitted.json").exists(), "what was refused is said to be submitted")


def lines_in_logs(plan, text):
    return sum(log.read_text(encoding="utf-8").count(text) for log in (plan / "jobs").glob("*_*.log"))


def check_jobs(cluster, plan):
    start = time.monotonic()
    cluster.skerry("farm", "submit", plan, "--tasks-per-job", 1, "--time", 5)
    done = cluster.skerry("farm", "submit", plan, status=1)
    check("has not ended" in done.stderr, done)
    wait_until("the first row", lambda: rows_of(plan))
    lost = lose_a_node(cluster, plan)
    done = cluster.skerry("farm", "status", plan)
    check(" 0 failed" in done.stdout and f"{SCENES} tasks: " in done.stdout, done)
    cluster.call("controller", "stop")
    time.sleep(1.0)
    cluster.call("controller", "start")
    page = plan / "page" / "index.html"
    wait_until("the merge", page.exists)
    print(f"{SCENES} tasks and their merge after {time.monotonic() - start:.0f} s, of which a node and the "
          "controller were away")
    state = cluster.call("run", "scontrol", "show", "job", lost)
    check("Restarts=1" in state, f"the job of the lost node did not run again: {state}")
    done = cluster.skerry("farm", "status", plan)
    check(f"{SCENES} have rows" in done.stdout, done)
    check(len(rows_of(plan)) == SCENES, "a row was lost")
    # One line less where the node died between its row and its line: the job then had nothing left to run.
    runs = lines_in_logs(plan, "1 tasks run")
    check(runs in (SCENES - 1, SCENES), f"{runs} runs wrote {SCENES} rows")


def check_alone(cluster, plan):
    """A task without a row runs again, and it alone."""
    runs = lines_in_logs(plan, "1 tasks run")
    task, row = next(iter(rows_of(plan).items()))
    (plan / "rows" / f"{task}.json").unlink()
    done = cluster.skerry("farm", "status", plan, status=1)
    check(" 1 failed" in done.stdout and "see " in done.stdout, done)
    wait_until("the merge job", lambda: not cluster.running())
    done = cluster.skerry("farm", "submit", plan, "--tasks-per-job", 1)
    check(done.stdout.startswith("1 tasks in 1 jobs: "), done)
    wait_until("the row that was missing", lambda: task in rows_of(plan))
    wait_until("the end of its job", lambda: not cluster.running())
    check(rows_of(plan)[task]["result"] == row["result"], "it gave another row")
    check(lines_in_logs(plan, "1 tasks run") == runs + 1, "other tasks ran again")


def kill_a_task(cluster, plan):
    """Ends a process of a task. @return whether there was one."""
    del cluster
    for process in processes_with(str(plan)):
        try:
            os.kill(process, signal.SIGKILL)
            return True
        except ProcessLookupError:
            continue
    return False


def kill_a_node(cluster, plan):
    del plan
    node = random.choice(NODES)
    cluster.call("kill", node)
    time.sleep(random.uniform(0.0, 6.0))  # at 4 s it counts as lost
    cluster.call("start", node)
    return True


def kill_the_controller(cluster, plan):
    del plan
    cluster.call("controller", "stop")
    time.sleep(random.uniform(0.0, 2.0))
    cluster.call("controller", "start")
    return True


def queue_of(cluster):
    return cluster.call("run", "squeue", "--noheader").split()


def check_rows(plan, whole, what):
    expected, rows = rows_of(whole), rows_of(plan)
    check(sorted(rows) == sorted(expected), f"{what}: {len(rows)} rows")
    for task, row in rows.items():
        check(row["result"] == expected[task]["result"], f"{what}: {row} is not {expected[task]}")


def check_kills(cluster, folder, whole, kills):
    """Until so many have been ended, plans run from the start; what fails is submitted again."""
    ends = [kill_a_task] * 6 + [kill_a_node] * 3 + [kill_the_controller]
    ended, plans, submits = dict.fromkeys(set(ends), 0), 0, 0
    while sum(ended.values()) < kills:
        plan = folder / f"killed_{plans}"
        plan.mkdir()
        shutil.copy(whole / "plan.json", plan)
        while len(rows_of(plan)) < SCENES:
            wait_until("the queue", lambda: not queue_of(cluster))
            cluster.skerry("farm", "submit", plan, "--tasks-per-job", 1, "--time", 5)
            submits += 1
            while queue_of(cluster) and sum(ended.values()) < kills:
                time.sleep(random.uniform(0.2, 2.0))
                end = random.choice(ends)
                ended[end] += end(cluster, plan)
            wait_until("the end of all jobs", lambda: not queue_of(cluster))
        check_rows(plan, whole, plan.name)
        lines = lines_in_logs(plan, "1 tasks run")
        check(lines <= SCENES, f"{plan.name}: {lines} runs wrote {SCENES} rows")
        plans += 1
    counts = ", ".join(f"{count} by {end.__name__}" for end, count in ended.items())
    print(f"{kills} ends ({counts}), {plans} plans, {submits} submits: no row lost, none doubled")


def check_full_disk(cluster, full, whole):
    """A row that cannot be written is none, and comes when there is room."""
    shutil.copy(whole / "plan.json", full)
    filler = full / "filler"
    with filler.open("wb", buffering=0) as file:
        try:
            while True:
                file.write(bytes(4096))
        except OSError:
            pass  # it is full
    done = cluster.skerry("test", "run", "--dir", full, status=1)
    check(done.stderr.count("\n") == 1 and "cannot write" in done.stderr, done)
    check(not rows_of(full), "a row was written where there is no room")
    filler.unlink()
    cluster.skerry("farm", "submit", full, "--tasks-per-job", 3, "--time", 5)
    wait_until("the end of all jobs", lambda: not queue_of(cluster))
    check_rows(full, whole, "a disk that was full")


def check_page(cluster, plan, whole):
    """But for times, all is as without Slurm."""
    expected = rows_of(whole)
    for task, row in rows_of(plan).items():
        check(row["result"] == expected[task]["result"], f"{row} is not {expected[task]}")
        write_row(plan, row | {"measured": expected[task]["measured"]})
    cluster.skerry("farm", "fetch", whole)
    fetched = plan.parent / "fetched"
    cluster.skerry("farm", "fetch", plan, "--to", fetched)
    for name in ("page", "rows.json", "rows.xml", "pictures"):
        check(same_bytes(whole / name, fetched / name), f"{name} differs from the one of one machine")


def main(program, folder, kills="0"):
    folder = Path(folder).resolve()
    able = subprocess.run([HERE / "cluster", "check"], capture_output=True, text=True, check=False)
    if able.returncode == 77:
        print(able.stdout, end="")
        sys.exit(77)
    cluster = Cluster(folder / "cluster", program)
    if (folder / "cluster" / "ids").is_dir():
        cluster.call("down")  # of a run that was ended
    shutil.rmtree(folder, ignore_errors=True)
    scenes, plan, whole = folder / "scenes", folder / "plan", folder / "whole"
    scenes.mkdir(parents=True)
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    for i in range(SCENES):
        scene = SKY | {"time": f"{7 + i}:00"}
        (scenes / f"sky_{7 + i:02}.json").write_text(json.dumps(scene), encoding="utf-8")
    subprocess.run([program, "test", scenes, "--approve"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([program, "test", "plan", scenes, "--repeat", str(RUNS), "--dir", plan],
                   check=True)
    whole.mkdir()
    shutil.copy(plan / "plan.json", whole)
    subprocess.run([program, "test", "run", "--dir", whole], check=True)
    full = folder / "full"
    full.mkdir()
    if int(kills):  # before the cluster, whose nodes see what is mounted then
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16m", "skerry", full], check=True)
    try:
        cluster.call("up")
        check_errors(cluster, plan)
        check_jobs(cluster, plan)
        check_alone(cluster, plan)
        check_page(cluster, plan, whole)
        if int(kills):
            check_full_disk(cluster, full, whole)
            check_kills(cluster, folder, whole, int(kills))
    finally:
        cluster.call("down")
        if int(kills):
            subprocess.run(["umount", full], check=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
