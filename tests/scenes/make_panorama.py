#!/usr/bin/env -S python3 -B
"""Paints the panorama of scenes and tests: a red evening sky that is brightest ahead, a green post on the
right, a blue one on the left, a white lamp high behind, and brown ground.

    tests/scenes/make_panorama.py FILE.hdr|FILE.exr
"""
import math
import struct
import sys
import zlib

COLUMNS, ROWS = 256, 128


def radiance(column, row):
    """Of a texel; azimuth 0 is ahead, positive to the right [degrees]."""
    azimuth = (column + 0.5) / COLUMNS * 360.0 - 180.0
    elevation = 90.0 - (row + 0.5) / ROWS * 180.0
    if elevation < 0.0:
        return (0.10, 0.06, 0.03)
    if math.hypot(abs(azimuth) - 180.0, elevation - 60.0) < 4.0:
        return (6.0, 6.0, 6.0)
    for middle, colour in ((90.0, (0.1, 0.9, 0.2)), (-90.0, (0.1, 0.2, 0.9))):
        if abs(azimuth - middle) < 5.0 and elevation < 40.0:
            return colour
    glow = math.exp(-(azimuth / 50.0) ** 2 - (elevation / 18.0) ** 2)
    return (0.10 + 1.8 * glow, 0.14 + 0.6 * glow, 0.30 + 0.1 * glow)


def shared_exponent(colour):
    """Four bytes, as Radiance makes them."""
    most = max(colour)
    if most < 1e-32:
        return (0, 0, 0, 0)
    mantissa, exponent = math.frexp(most)
    scale = mantissa * 256.0 / most
    return (*(int(part * scale) for part in colour), exponent + 128)


def in_runs(values):
    """One part of a row: runs of equal bytes, and others as they are."""
    out = bytearray()
    at = 0
    while at < len(values):
        end = at
        while end < len(values) and end - at < 127 and values[end] == values[at]:
            end += 1
        if end - at > 2:
            out += bytes((128 + end - at, values[at]))
        else:
            end = at + 1
            while end < len(values) and end - at < 128 and values[end:end + 3] != values[end:end + 1] * 3:
                end += 1
            out += bytes((end - at,)) + bytes(values[at:end])
        at = end
    return bytes(out)


def radiance_picture():
    picture = bytearray(b"#?RADIANCE\n# by tests/scenes/make_panorama.py\nFORMAT=32-bit_rle_rgbe\n\n")
    picture += b"-Y %d +X %d\n" % (ROWS, COLUMNS)
    for row in range(ROWS):
        texels = [shared_exponent(radiance(column, row)) for column in range(COLUMNS)]
        picture += bytes((2, 2, COLUMNS >> 8, COLUMNS & 255))
        for part in range(4):
            picture += in_runs([texel[part] for texel in texels])
    return picture


def zipped(row):
    """As OpenEXR compresses a row by itself: even bytes, odd bytes, differences, zlib."""
    parted = row[0::2] + row[1::2]
    steps = bytes((b - a + 128) & 255 for a, b in zip(parted, parted[1:]))
    packed = zlib.compress(parted[:1] + steps, 9)
    return packed if len(packed) < len(row) else row


def openexr_picture():
    """Halves, a row a chunk. Source: OpenEXR, "OpenEXR File Layout"."""
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value

    window = struct.pack("<4i", 0, 0, COLUMNS - 1, ROWS - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    header = struct.pack("<ii", 20000630, 2) + b"".join((
        attribute(b"channels", b"chlist", channels), attribute(b"compression", b"compression", b"\x02"),
        attribute(b"dataWindow", b"box2i", window), attribute(b"displayWindow", b"box2i", window),
        attribute(b"lineOrder", b"lineOrder", b"\0"), attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
        attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)))) + b"\0"
    offsets, chunks = [], bytearray()
    for row in range(ROWS):
        texels = [radiance(column, row) for column in range(COLUMNS)]
        data = zipped(b"".join(struct.pack(f"<{COLUMNS}e", *(texel[part] for texel in texels)) for part in (2, 1, 0)))
        offsets.append(len(header) + 8 * ROWS + len(chunks))
        chunks += struct.pack("<ii", row, len(data)) + data
    return header + struct.pack(f"<{ROWS}Q", *offsets) + chunks


def main(path):
    picture = openexr_picture() if path.endswith(".exr") else radiance_picture()
    with open(path, "wb") as file:
        file.write(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
