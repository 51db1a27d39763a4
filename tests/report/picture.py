"""A small picture of a report as it is opened: picture.py REPORT.html PICTURE.png [SCRIPT]. SCRIPT runs in the page before."""

import base64
import struct
import sys
import zlib

from browser import Browser

LEVELS = 32  # of red, green and blue


def unfiltered(png):
    """Width, height and the R, G, B (and A) bytes of a PNG of 8 bits without interlace, row by row."""
    width, height, _, kind = struct.unpack(">IIBB", png[16:26])
    data, at = b"", 8
    while at < len(png):
        length, name = struct.unpack(">I4s", png[at:at + 8])
        if name == b"IDAT":
            data += png[at + 8:at + 8 + length]
        at += 12 + length
    data, size = zlib.decompress(data), 4 if kind == 6 else 3
    above, rows = bytearray(width * size), []
    for start in range(0, len(data), width * size + 1):
        method, row = data[start], bytearray(data[start + 1:start + 1 + width * size])
        for i in range(len(row)):
            left, corner = (row[i - size], above[i - size]) if i >= size else (0, 0)
            if method == 1:
                row[i] = row[i] + left & 255
            elif method == 2:
                row[i] = row[i] + above[i] & 255
            elif method == 3:
                row[i] = row[i] + (left + above[i]) // 2 & 255
            elif method == 4:
                p = left + above[i] - corner
                distances = abs(p - left), abs(p - above[i]), abs(p - corner)
                row[i] = row[i] + (left, above[i], corner)[distances.index(min(distances))] & 255
        rows.append(row)
        above = row
    return width, height, size, rows


def with_palette(png):
    """The same picture in the 256 most frequent of its colours."""
    width, height, size, rows = unfiltered(png)
    nearest = bytes(round(value * (LEVELS - 1) / 255) for value in range(256))
    pixels = [list(zip(*(row[k::size].translate(nearest) for k in range(3)))) for row in rows]
    counts = {}
    for row in pixels:
        for color in row:
            counts[color] = counts.get(color, 0) + 1
    palette = sorted(counts, key=counts.get, reverse=True)[:256]
    index = {color: k for k, color in enumerate(palette)}
    for color in counts.keys() - index.keys():
        index[color] = index[min(palette, key=lambda other: sum((a - b) ** 2 for a, b in zip(color, other)))]
    data = b"".join(b"\0" + bytes(index[color] for color in row) for row in pixels)
    parts = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)),
             (b"PLTE", bytes(round(value * 255 / (LEVELS - 1)) for color in palette for value in color)),
             (b"IDAT", zlib.compress(data, 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(part)) + name + part + struct.pack(">I", zlib.crc32(name + part)) for name, part in parts)


with Browser(size=(1200, 1080)) as page:
    page.open(sys.argv[1])
    page.value(sys.argv[3] if len(sys.argv) > 3 else "0")
    page.value("new Promise(done => setTimeout(done, 2000))")  # the view has come to rest
    if page.complaints:
        sys.exit(f"the console says {page.complaints}")
    taken = base64.b64decode(page.call("Page.captureScreenshot", format="png")["data"])
with open(sys.argv[2], "wb") as file:
    file.write(with_palette(taken))
