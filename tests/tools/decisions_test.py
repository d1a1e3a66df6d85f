#!/usr/bin/env python3
"""Clicks on the page of a failed `skerry test`, and applies what the page saves.

    decisions_test.py SKERRY_PROGRAM FOLDER      FOLDER is made anew

The page's script runs in Node.js, with stand-ins for the few parts of a browser that it uses; exit
status 77 (skipped) without Node.js.
"""
import json
import os
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

from commands_test import SKY, Runs, check

# Elements are objects with what the scripts ask of them. `boxes`, `clicks` and `script` are set by click(); a
# box has its section's picture, as `actual`.
STAND_INS = """
class Element {
  constructor(dataset = {}, buttons = []) {
    Object.assign(this, { dataset, buttons, attributes: {}, listeners: [], disabled: true });
  }
  querySelectorAll(what) { if (what !== "button") throw what; return this.buttons; }
  closest(what) { if (what !== "section") throw what; return this; }
  querySelector(what) { if (what !== ".actual img") throw what; return { src: this.actual }; }
  setAttribute(name, value) { this.attributes[name] = value; }
  addEventListener(event, listener) { if (event !== "click") throw event; this.listeners.push(listener); }
  click() {
    if (this.download) console.log(JSON.stringify({ name: this.download, text: this.href }));
    for (const listener of this.listeners) listener();
  }
}
const output = new Element(), save = new Element();
const all = boxes.map(box => new Element(box.data, box.buttons.map(data => new Element(data))));
boxes.forEach((box, i) => all[i].actual = box.actual);
globalThis.document = {
  querySelector: what => ({ ".decisions output": output, ".decisions button": save })[what],
  querySelectorAll: what => ({ ".decide": all, ".blink": [], ".inlined": [] })[what],
  createElement: () => new Element(),
};
globalThis.Blob = class { constructor(parts) { this.text = parts.join(""); } };
globalThis.URL = { createObjectURL: blob => blob.text };
eval(script);
for (const [scene, decision] of clicks) {
  const box = all.find(one => one.dataset.scene === scene);
  box.buttons.find(one => one.dataset.decision === decision).click();
}
console.log(JSON.stringify({ count: output.textContent, disabled: save.disabled,
  pressed: all.flatMap(box => box.buttons.filter(one => one.attributes["aria-pressed"] === "true")
                               .map(one => [box.dataset.scene, one.dataset.decision])) }));
save.click();
"""


class Page(HTMLParser):
    """The parts of a page that its script works on."""

    def __init__(self, text):
        super().__init__()
        self.boxes, self.script, self.in_script, self.figure = [], "", False, ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        data = {name[5:]: value for name, value in attrs if name.startswith("data-")}
        given = dict(attrs)
        if given.get("class") == "decide":
            self.boxes.append({"data": data, "buttons": []})
        elif tag == "figure":
            self.figure = given["class"]
        elif tag == "img" and self.figure.startswith("actual"):
            self.boxes[-1]["actual"] = given["src"]
        elif tag == "button" and data:
            self.boxes[-1]["buttons"].append(data)
        self.in_script = tag == "script"

    def handle_endtag(self, tag):
        self.in_script = False

    def handle_data(self, data):
        if self.in_script:
            self.script += data


def click(page, *clicks):
    """Clicks on (scene, decision) in turn, then saves. @return what the page shows, and the file."""
    given = "".join(f"const {name} = {json.dumps(value)};\n" for name, value in
                    (("boxes", page.boxes), ("script", page.script), ("clicks", clicks)))
    done = subprocess.run(["node", "-"], input=given + STAND_INS, capture_output=True, text=True,
                          check=False)
    check(done.returncode == 0, done.stderr)
    shown, saved = map(json.loads, done.stdout.splitlines())
    check(saved["name"] == "decisions.json", saved)
    return shown, saved["text"]


def main(program, folder):
    if not shutil.which("node"):
        print("skipped: there is no Node.js to run the page's script")
        sys.exit(77)
    folder = Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    scenes, report = folder / "scenes", folder / "report"
    scenes.mkdir(parents=True)
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    run = Runs(program)
    names = ["day", "dusk", "two words & \"quotes\""]
    for name in names:
        (scenes / f"{name}.json").write_text(json.dumps(SKY), encoding="utf-8")
    run("test", scenes, "--html", report, status=1)
    page = Page((report / "index.html").read_text(encoding="utf-8"))
    check([box["data"]["scene"] for box in page.boxes] == names, page.boxes)

    shown, _ = click(page, ["day", "approve"], ["day", "approve"])
    check(shown == {"count": "0 decided", "disabled": True, "pressed": []}, shown)
    shown, text = click(page, ["day", "reject"], [names[2], "approve"], ["dusk", "reject"],
                        ["day", "approve"])
    check(shown["count"] == "3 decided" and not shown["disabled"], shown)
    check(shown["pressed"] == [["day", "approve"], ["dusk", "reject"], [names[2], "approve"]], shown)
    decisions = folder / "decisions.json"
    decisions.write_text(text, encoding="utf-8")
    # The page and what it saves are enough: they may have been sent elsewhere.
    report.rename(folder / "elsewhere")
    done = run("test", "approve", decisions, scenes)
    check(done.stdout.count("approved: ") == 2 and "rejected: dusk" in done.stdout, done)
    for name in names:
        check((scenes / f"{name}.png").exists() == (name != "dusk"), f"{name} after the decisions")
    run("test", scenes / "day.json", scenes / f"{names[2]}.json")
    run("test", scenes, status=1)
    run("test", "approve", decisions, status=2)
    (folder / "elsewhere").rename(report)
    run("test", "approve", decisions, scenes, "--report", report)
    run("test", "--approve", "approve", decisions, scenes, "--report", report, status=2)
    run("test", "approve", report / "index.html", scenes, "--report", report, status=1)


if __name__ == "__main__":
    main(*sys.argv[1:])
