#!/usr/bin/env python3
"""skerry_compare_images on pictures made to be just alike, just different, or unreadable.

    compare_images_test.py COMPARER
"""
import json
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

WIDTH, HEIGHT = 40, 20  # 800 pixels: 4 outliers are the most allowed
COMPARER = sys.argv.pop(1)


def png(pixels):
    """An 8-bit RGB file."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(sum(pixels[y * WIDTH:(y + 1) * WIDTH], ())) for y in range(HEIGHT))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class CompareImages(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.plain = [(100, 100, 100)] * (WIDTH * HEIGHT)

    def compare(self, expected, actual):
        """Exit status, what was printed, and whether a difference picture was left."""
        (self.folder / "a.png").write_bytes(expected)
        (self.folder / "b.png").write_bytes(actual)
        left = self.folder / "difference.png"
        done = subprocess.run([COMPARER, self.folder / "a.png", self.folder / "b.png", left],
                              capture_output=True, text=True)
        return done.returncode, json.loads(done.stdout) if done.stdout else None, left.exists()

    def changed(self, count, by):
        return png([(100, 100 + by, 100)] * count + self.plain[count:])

    def test_equal_pictures_are_exact_and_leave_no_difference(self):
        status, found, left = self.compare(png(self.plain), png(self.plain))
        self.assertEqual((status, found["exact"], found["different"], left), (0, True, 0, False))

    def test_every_pixel_may_be_off_by_the_tolerance(self):
        for by in (8, -8):
            status, found, left = self.compare(png(self.plain), self.changed(WIDTH * HEIGHT, by))
            self.assertEqual((status, found["outliers"], found["largest"], left), (0, 0, 8, True))

    def test_half_a_percent_may_be_off_by_anything_and_no_more(self):
        self.assertEqual(self.compare(png(self.plain), self.changed(4, 155))[0], 0)
        self.assertEqual(self.compare(png(self.plain), self.changed(5, 155))[0], 1)
        self.assertEqual(self.compare(png(self.plain), self.changed(5, 9))[0], 1)

    def test_only_what_can_be_seen_counts_as_bright(self):
        picture = png([(15, 15, 15)] * (WIDTH * HEIGHT - 3) + [(0, 16, 0)] * 3)
        self.assertEqual(self.compare(picture, picture)[1]["bright"], 3)

    def test_what_is_no_picture_is_refused(self):
        self.assertEqual(self.compare(png(self.plain), b"no picture")[0], 2)
        self.assertEqual(self.compare(png(self.plain)[:60], png(self.plain))[0], 2)


if __name__ == "__main__":
    unittest.main()
