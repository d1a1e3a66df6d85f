"""Pictures of scenes by the built program, for the image tests. Python's standard library only."""
import json
import subprocess
from pathlib import Path

SCENES = Path(__file__).resolve().parent.parent / "scenes"


class Refused(Exception):
    """The program said no, in one line."""


def software_device(skerry):
    """Index of Mesa's software device, which all references were drawn with."""
    listed = subprocess.run([skerry, "devices", "--json"], capture_output=True, text=True)
    devices = json.loads(listed.stdout)["devices"] if listed.returncode == 0 else []
    for device in devices:
        if "llvmpipe" in device["name"] and device["usable"]:
            return str(device["index"])
    raise Refused("no llvmpipe among the Vulkan devices; install mesa-vulkan-drivers")


def shoot(skerry, folder, name, arguments):
    """Draws one picture under the validation layer. Returns its path and the numbers of --stats."""
    folder.mkdir(parents=True, exist_ok=True)
    picture, stats = folder / f"{name}.png", folder / f"{name}.json"
    done = subprocess.run([skerry, "shot", *arguments, "--validate", "--device", software_device(skerry),
                           "--out", picture, "--stats", stats], capture_output=True, text=True)
    if done.returncode != 0:
        raise Refused(f"shot ended with status {done.returncode}:\n{done.stdout}{done.stderr}")
    return picture, json.loads(stats.read_text(encoding="utf-8"))


def compare(comparer, reference, picture, difference):
    """What tests/image/compare_images.cpp found out, as a dictionary."""
    done = subprocess.run([comparer, reference, picture, difference], capture_output=True, text=True)
    if done.returncode == 2:
        raise Refused(done.stderr.strip())
    return json.loads(done.stdout)
