#!/usr/bin/env python3
"""Clicks on the page of a failed `skerry test` in Chromium, from disk, and applies the file that it saves.

    decisions_browser_test.py SKERRY_PROGRAM FOLDER      FOLDER is made anew

Exit status 77 (skipped) without `chromedriver` and `chromium`. What each click does to the page is judged by
decisions_test.py, which needs no browser.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

from commands_test import SKY, Runs, check

WAIT_S = 60
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # key of an element's id (W3C WebDriver, section 12)


class Browser:
    """A session of Chromium without a screen, by the WebDriver protocol."""

    def __init__(self, downloads):
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
        started = next((found for line in self.driver.stdout
                        if (found := re.search(r"started successfully on port (\d+)", line))), None)
        check(started, "chromedriver did not start")
        self.address = f"http://127.0.0.1:{started[1]}/session"
        arguments = ["--headless=new", "--disable-gpu", f"--user-data-dir={downloads}/profile"]
        if os.geteuid() == 0:
            arguments.append("--no-sandbox")  # Chromium refuses root with one
        options = {"args": arguments, "prefs": {"download.default_directory": str(downloads)}}
        opened = self.ask("", {"capabilities": {"alwaysMatch": {"goog:chromeOptions": options}}})
        self.address += f"/{opened['sessionId']}"

    def ask(self, path, data, method="POST"):
        request = urllib.request.Request(self.address + path, json.dumps(data).encode(),
                                         {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=WAIT_S) as answer:
                return json.loads(answer.read())["value"]
        except urllib.error.HTTPError as refused:
            return check(False, refused.read().decode())  # ends the test

    def click(self, selector):
        found = self.ask("/element", {"using": "css selector", "value": selector})
        # As a person scrolls: at the lower edge the bar that saves lies over it.
        self.ask("/execute/sync", {"script": "arguments[0].scrollIntoView({ block: 'center' })", "args": [found]})
        self.ask(f"/element/{found[ELEMENT]}/click", {})

    def value(self, script):
        return self.ask("/execute/sync", {"script": script, "args": []})

    def close(self):
        self.ask("", {}, "DELETE")  # else the browser outlives its driver
        self.driver.terminate()
        self.driver.wait(WAIT_S)


def downloaded(path):
    """The bytes of a download, read while the browser runs: its empty file is there before them, and a browser that
    ends may remove what it has not yet noted as saved.
    """
    for _ in range(10 * WAIT_S):
        if path.exists() and (saved := path.read_bytes()):
            return saved
        time.sleep(0.1)
    return check(False, f"{path} did not come")  # ends the test


def main(program, folder):
    if not shutil.which("chromedriver") or not shutil.which("chromium"):
        print("skipped: there is no chromedriver with chromium")
        sys.exit(77)
    folder = Path(folder).resolve()
    decisions = folder / "decisions.json"
    shutil.rmtree(folder, ignore_errors=True)
    scenes, report, downloads = folder / "scenes", folder / "report", folder / "downloads"
    for made in (scenes, downloads):
        made.mkdir(parents=True)
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    run = Runs(program)
    for name in ("day", "dusk", "night"):
        (scenes / f"{name}.json").write_text(json.dumps(SKY), encoding="utf-8")
    run("test", scenes, "--html", report, status=1)
    browser = Browser(downloads)
    try:
        browser.ask("/url", {"url": (report / "index.html").as_uri()})
        sizes = browser.value("return [...document.images].map(one => [one.complete, one.naturalWidth])")
        check(sizes and all(complete and width for complete, width in sizes), sizes)
        for scene, decision in (("day", "reject"), ("dusk", "reject"), ("day", "approve")):
            browser.click(f'[data-scene="{scene}"] button[data-decision="{decision}"]')
        shown = browser.value('return document.querySelector(".decisions output").textContent')
        check(shown == "2 decided", shown)
        browser.click(".decisions button")
        decisions.write_bytes(downloaded(downloads / "decisions.json"))
    finally:
        browser.close()
    done = run("test", "approve", decisions, scenes)
    check(done.stdout.count("approved: ") == 1 and "rejected: dusk" in done.stdout, done)
    check((scenes / "day.png").exists() and not (scenes / "dusk.png").exists(), "what was applied")
    run("test", scenes / "day.json")


if __name__ == "__main__":
    main(*sys.argv[1:])
