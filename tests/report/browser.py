"""A page in Debian's chromium, without a window, by Debian's selenium: /usr/bin/python3 has it."""

import base64
import json
import os
import time

from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.chrome.service import Service


class Browser:
    def __init__(self, size=(1400, 1000)):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--use-angle=swiftshader",
                         "--no-first-run", "--disable-extensions", "--disable-background-networking", "--disable-dev-shm-usage"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
        self._complaints = []
        self.look(*size, "light")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.driver.quit()

    @property
    def process(self):
        """That of the driver, whose children are the browser's."""
        return self.driver.service.process

    @property
    def complaints(self):
        """Errors, and fetches that the page should not make."""
        self._complaints += [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                url = message["params"]["request"]["url"]
                if url.startswith(("http", "ftp", "ws")):
                    self._complaints.append("fetched " + url)
        return self._complaints

    def call(self, method, **params):
        """A command of the DevTools protocol."""
        return self.driver.execute_cdp_cmd(method, params)

    def open(self, place):
        """A file or an http address; seconds until the page has loaded and its scripts have run."""
        start = time.monotonic()
        self.driver.get(place if place.startswith("http://") else "file://" + os.path.abspath(place))
        return time.monotonic() - start

    def value(self, expression):
        """Of an expression of the page; a promise is waited for."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise WebDriverException(details.get("exception", {}).get("description", details["text"]))
        return answer["result"].get("value")

    def look(self, width, height, scheme):
        """At a page of this size, px, by a reader who wants it "light" or "dark"."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.value("new Promise(done => requestAnimationFrame(() => setTimeout(done, 100)))")

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)

    def move(self, x, y):
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)

    def key(self, key, text=None):
        more = {"text": text} if text else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **more)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def paper(self):
        """The page as it is printed on A4: a PDF."""
        return base64.b64decode(self.call("Page.printToPDF", printBackground=True, paperWidth=8.27, paperHeight=11.69)["data"])

    def picture(self, path):
        self.driver.save_screenshot(path)
