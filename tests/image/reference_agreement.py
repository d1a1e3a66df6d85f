#!/usr/bin/env python3
"""Judges the renderer by the reference: FLIP mean of eight scenes, nothing masked, and what each took.

  tests/image/reference_agreement.py SKERRY [WAY|SCENE...]

Three ways of drawing each scene: `frame`, which a player sees at medium with smoothed edges,
`still`, and `long`, a still that resolves the sun's disc, shadow edges and far levels of detail
(docs/reference.md). The reference samples geometry over whole pixels.
The device must be able to hold shadow maps of 8192 texels; on a CPU a long still takes minutes.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ["day", "dusk", "moonlit", "water", "cave", "tropical", "mesa", "high_altitude"]
FRAME = {"aa": "edge"}
STILL = {"view.detail": 1024, "aa.samples": 16, "shadow.size": 4096, "shadow.samples": 8,
         "shadow.taps": 4, "lights.shadows": "all"}
LONG = STILL | {"view.detail": 4096, "shadow.size": 8192, "shadow.samples": 64}
WAYS = {"frame": FRAME, "still": STILL, "long": LONG}
# From up there nothing is near: the maps are shared out for what is far.
LONG_OF = {"high_altitude": LONG | {"shadow.split": 0.75}}


def run(*command):
    """Seconds that a command took; ends the program with its message if it failed."""
    started = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):  # 1: pictures differ, which is what is measured
        sys.exit(done.stderr)
    return time.monotonic() - started


def measure(skerry, name, way, settings, folder):
    scene = json.loads((ROOT / "tests/scenes" / f"{name}.json").read_text())
    scene["size"] = "960x540"
    scene["settings"] = scene.get("settings", {}) | settings
    place = folder / f"{name}.json"
    place.write_text(json.dumps(scene))
    picture = place.with_suffix(".png")
    stats = folder / "stats.json"
    reference = [skerry, "shot", "--scene", place, "--renderer", "reference", "--stats", stats,
                 "--out", picture]
    # Both at one exposure, so that light is compared and not how it was metered.
    run(*reference, "--set", "reference.samples=8")
    scene["settings"]["exposure"] = round(json.loads(stats.read_text())["exposure_ev"], 3)
    place.write_text(json.dumps(scene))
    reference_s = run(*reference, "--set", f"reference.samples={512 if way == 'long' else 64}",
                      "--set", "reference.filter=pixel")
    error = json.loads(stats.read_text())["error"]
    rows = folder / "rows.json"
    run(skerry, "test", place, "--json", rows, "--html", folder / f"{name} {way}")
    shot_s = run(skerry, "shot", "--scene", place, "--stats", stats, "--out", folder / "shot.png")
    row = json.loads(rows.read_text())["rows"][0]
    gpu_ms = json.loads(stats.read_text())["gpu_ms"]["total"]
    print(f"{name:14} {way:6} FLIP mean {row['flip_mean']:.4f}  GPU {gpu_ms:8.2f} ms  "
          f"shot {shot_s:6.2f} s  reference {reference_s:6.2f} s, its standard error "
          f"{100 * error['mean_standard_error'] / error['mean_radiance']:.2f}%", flush=True)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        for name in [a for a in sys.argv[2:] if a not in WAYS] or SCENES:
            for way in [a for a in sys.argv[2:] if a in WAYS] or WAYS:
                settings = LONG_OF.get(name, LONG) if way == "long" else WAYS[way]
                measure(sys.argv[1], name, way, settings, pathlib.Path(folder))


if __name__ == "__main__":
    main()
