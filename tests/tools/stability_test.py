#!/usr/bin/env python3
"""Runs `skerry stability` as a user would: every row passes, and wrong use is refused.

    stability_test.py SKERRY_PROGRAM FOLDER      FOLDER keeps the rows

Long runs have the validation layer watch, for a third more time. What it prints is what
docs/stability_rows.md keeps: the same rows with the same bounds, and none of those bounds is more
than four times what was observed.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

FEWEST_ROWS = 40
TABLE = Path(__file__).resolve().parent.parent.parent / "docs" / "stability_rows.md"
REMEDY = "print it anew: skerry stability (docs/stability.md says how)"


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
    validate = ["--validate"] if "SKERRY_LONG_TESTS" in os.environ else []
    done = run(program, *validate, "--json", str(file))
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
    return done.stdout


def table_of(text):
    """(case, quantity) -> (bound, observed), as they are written in a table in Markdown."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return {(row[0], row[1]): (row[2], row[3]) for row in cells if row[0] != "case"}


def check_table(printed):
    kept = table_of(TABLE.read_text(encoding="utf-8"))
    printed = table_of(printed)
    check(kept.keys() == printed.keys(),
          f"{TABLE.name} and the program differ in {sorted(kept.keys() ^ printed.keys())}; {REMEDY}")
    for row, (bound, observed) in kept.items():
        check(printed[row][0] == bound,
              f"{TABLE.name} has the bound {bound} for {row}, not {printed[row][0]}; {REMEDY}")
        # Three digits are printed of each.
        check(float(bound) <= 4.04 * float(observed),
              f"{row} is bound to {bound}, more than four times the {observed} that is seen")


def main(program, folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    check_refusals(program, folder)
    check_table(check_rows(program, folder))


if __name__ == "__main__":
    main(*sys.argv[1:])
