#!/usr/bin/env python3
"""Checks the links of HTML pages: every target exists, every id is well-formed and unique.

    page_links.py PAGE...       exit status: 1 if there is a fault; one line each

A link to '#x' needs an element of that id on the page; any other needs its file beside the page,
as does the source of a picture unless it is a PNG or SVG itself, in base64. An id is well-formed as HTML says: at least one character and no
white space; and none of the characters that stand for bytes which are no text.
"""
import base64
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote


class Page(HTMLParser):
    def __init__(self):
        super().__init__()
        self.ids, self.links, self.sources = [], [], []

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name == "id":
                self.ids.append(value or "")
            elif name == "href":
                self.links.append(value or "")
            elif name == "src":
                self.sources.append(value or "")


HEADS = {"data:image/png;base64": b"\x89PNG\r\n\x1a\n", "data:image/svg+xml;base64": b"<svg "}


def is_picture(source):
    """Of an address that is the picture itself."""
    kind, _, data = source.partition(",")
    try:
        return base64.b64decode(data, validate=True).startswith(HEADS[kind])
    except (KeyError, ValueError):
        return False


def read_page(path):
    page = Page()
    page.feed(path.read_bytes().decode("utf-8", errors="replace"))
    page.close()
    return page


def faults_of(path):
    """What is wrong on a page, a line each."""
    page = read_page(path)
    found = [f"id {name!r} is no id" for name in page.ids
             if not name or re.search(r"[\s\x00-\x1f\x7f\ufffd]", name)]
    found += [f"id {name!r} is there {page.ids.count(name)} times" for name in sorted(set(page.ids))
              if page.ids.count(name) > 1]
    for link in page.links:
        # A browser looks for the fragment as it stands first, then for what it encodes.
        if link.startswith("#"):
            if not {link[1:], unquote(link[1:])} & set(page.ids):
                found.append(f"link {link!r} has no target")
        elif not link or not (path.parent / unquote(link)).is_file():
            found.append(f"link {link!r} leads to no file")
    found += [f"picture {source[:100]!r} is no file" for source in page.sources
              if not (is_picture(source) if source.startswith("data:")
                      else (path.parent / unquote(source)).is_file())]
    return [f"{path}: {fault}" for fault in found]


def main(paths):
    found = [fault for path in paths for fault in faults_of(Path(path))]
    print("\n".join(found))
    return 1 if found or not paths else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
