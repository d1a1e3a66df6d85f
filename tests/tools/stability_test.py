#!/usr/bin/env python3
"""Runs `skerry stability` as a user would: every row passes, and wrong use is refused.

    stability_test.py SKERRY_PROGRAM FOLDER      FOLDER keeps the rows
"""
import json
import subprocess
import sys
from pathlib import Path

FEWEST_ROWS = 40


def run(program, *arguments):
    return subprocess.run([program, "stability", *arguments], capture_output=True, text=True,
                          check=False)


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def check_refusals(program, folder):
    for arguments in (["no_such_case"], ["--no-such-option"], ["--device", "x"],
                      ["--json", str(folder / "missing" / "rows.json"), "exposure"]):
        done = run(program, *arguments)
        check(done.returncode in (1, 2), f"{arguments} gave status {done.returncode}")
        check(done.stderr.startswith("skerry: ") and done.stderr.count("\n") == 1,
              f"{arguments} said {done.stderr!r}")
        check(done.stdout == "", f"{arguments} printed {done.stdout!r}")


def check_rows(program, folder):
    file = folder / "stability.json"
    file.unlink(missing_ok=True)
    done = run(program, "--validate", "--json", str(file))
    print(done.stdout, done.stderr)
    check(done.returncode == 0, f"status {done.returncode}")
    rows = json.loads(file.read_text(encoding="utf-8"))["rows"]
    check(len(rows) >= FEWEST_ROWS, f"only {len(rows)} rows")
    for row in rows:
        check(list(row) == ["case", "quantity", "bound", "observed", "pass"], f"fields of {row}")
        check(row["pass"] is True and row["observed"] <= row["bound"], f"{row}")
    named = {(row["case"], row["quantity"]) for row in rows}
    check(len(named) == len(rows), "two rows have one name")
    listed = run(program, "--list").stdout.split()
    check(sorted(listed) == sorted({row["case"] for row in rows}), "a listed case gave no row")


def main(program, folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    check_refusals(program, folder)
    check_rows(program, folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
