#!/usr/bin/env -S python3 -B
"""The same scene gives the same bytes, whatever must not matter: another run, the number of worker
threads, the way meshes are uploaded, and how far from the origin the world is.

    same_bytes_test.py SKERRY FOLDER
"""
import json
import os
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

SCENES = Path(__file__).resolve().parent.parent / "scenes"
OFFSETS = ((0, 0, 0), (16777216, 0, 0), (1099511627000, 1099511627000, -1099511627000))


class Refused(Exception):
    """The program said no, in one line."""


def shoot(skerry, folder, name, arguments):
    """Draws one picture under the validation layer. Returns the numbers of --stats."""
    folder.mkdir(parents=True, exist_ok=True)
    stats = folder / f"{name}.json"
    done = subprocess.run([skerry, "shot", *arguments, "--validate", "--out", folder / f"{name}.png",
                           "--stats", stats], capture_output=True, text=True)
    if done.returncode != 0:
        raise Refused(f"shot ended with status {done.returncode}:\n{done.stdout}{done.stderr}")
    return json.loads(stats.read_text(encoding="utf-8"))


def decimal(value):
    """An exact decimal number; camera places of the scenes end after a few digits."""
    text = f"{abs(value.numerator) * 10**6 // value.denominator:07d}"
    return f"{'-' if value < 0 else ''}{text[:-6]}.{text[-6:]}"


def moved(scene, offset):
    """Arguments that move a scene's world and camera."""
    x, y, z, yaw, pitch = json.loads(scene.read_text(encoding="utf-8"))["camera"]
    place = [decimal(Fraction(str(at)) + by) for at, by in zip((x, y, z), offset)]
    return ["--camera", ",".join(place + [str(yaw), str(pitch)]),
            "--set", "world.offset=" + ",".join(map(str, offset))]


def variants(scene):
    yield "again", []
    # In short runs one scene has the half of what must not matter that the other has not.
    whole, half = "SKERRY_LONG_TESTS" in os.environ, scene.stem == "water"
    for threads in (1, 8):
        if whole or half == (threads == 1):
            yield f"{threads}_threads", ["--set", f"jobs.threads={threads}"]
    for path in ("update", "staging", "mapped"):
        if whole or half == (path != "staging"):
            yield path, ["--set", f"upload.path={path}"]
    for number, offset in enumerate(OFFSETS):
        if whole or half == (number == 2):
            yield f"offset_{number}", moved(scene, offset)


def main(skerry, folder):
    wrong = []
    for name in ("water", "tropical"):
        scene = SCENES / f"{name}.json"
        shot = ["--scene", scene]
        first = shoot(skerry, Path(folder), name, shot)
        for variant, arguments in variants(scene):
            stats = shoot(skerry, Path(folder), f"{name}_{variant}", shot + arguments)
            same = stats["image_sha256"] == first["image_sha256"]
            print(f"{name} {variant}: {'same' if same else 'DIFFERENT'}")
            if not same:
                wrong.append(f"{name}_{variant}")
    if wrong:
        raise Refused(f"not the bytes of the first picture: {', '.join(wrong)}; see {folder}")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except Refused as why:
        sys.exit(f"same_bytes_test: {why}")
