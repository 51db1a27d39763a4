"""A small picture of the first screen of a report: picture.py REPORT.html PICTURE.png [SCRIPT]. SCRIPT runs in the page before."""

import base64
import io
import sys

from browser import Browser
from PIL import Image

with Browser() as page:
    page.open(sys.argv[1])
    page.look(1400, 900, "light")
    page.value(sys.argv[3] if len(sys.argv) > 3 else "0")
    page.value("new Promise(done => setTimeout(done, 2000))")  # the view has come to rest
    if page.complaints:
        sys.exit(f"the console says {page.complaints}")
    taken = Image.open(io.BytesIO(base64.b64decode(page.call("Page.captureScreenshot", format="png")["data"])))
taken.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(sys.argv[2], optimize=True)
