"""A page in Debian's firefox-esr, without a window, by the Marionette protocol; asked as a `Browser` is.

Selenium would need geckodriver, which Debian 12 does not have. Without a graphics card WebGL takes Debian's libgl1-mesa-dri, libegl1 and xvfb."""

import base64
import json
import os
import shutil
import socket
import subprocess
import tempfile
import time

SETTINGS = {"marionette.port": 0, "webgl.force-enabled": True, "app.update.enabled": False, "browser.shell.checkDefaultBrowser": False,
            "datareporting.policy.dataSubmissionEnabled": False, "network.captive-portal-service.enabled": False}
KEYS = {"ArrowLeft": "\ue012", "ArrowUp": "\ue013", "ArrowRight": "\ue014", "ArrowDown": "\ue015", "End": "\ue010", "Home": "\ue011"}


class Firefox:
    def __init__(self, program="firefox-esr", size=(1400, 1000)):
        self.folder = tempfile.TemporaryDirectory(prefix="cncplan-firefox-", ignore_cleanup_errors=True)
        with open(os.path.join(self.folder.name, "user.js"), "w") as file:
            for name, value in SETTINGS.items():
                file.write(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n")
        display = ["xvfb-run", "-a"] if shutil.which("xvfb-run") else []
        self.process = subprocess.Popen([*display, program, "--headless", "--marionette", "--remote-allow-system-access",
                                         "--no-remote", "--profile", self.folder.name],
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._socket = socket.create_connection(("127.0.0.1", self._port()))
        self._rest = b""
        self._count = 0
        self._message()  # who it is
        self.call("WebDriver:NewSession")
        self.call("WebDriver:SetWindowRect", width=size[0], height=size[1] + 85)  # with the bars that no one sees

    def _port(self):
        path = os.path.join(self.folder.name, "MarionetteActivePort")
        for _ in range(600):
            if os.path.exists(path) and os.path.getsize(path):
                with open(path) as file:
                    return int(file.read())
            time.sleep(0.1)
        raise RuntimeError("the browser has not started")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("Marionette:Quit", flags=["eForceQuit"])
            self.process.wait(20)
        except Exception:
            self.process.kill()
            self.process.wait()
        self._socket.close()
        self.folder.cleanup()

    def _message(self):
        while b":" not in self._rest:
            self._take()
        size, self._rest = self._rest.split(b":", 1)
        while len(self._rest) < int(size):
            self._take()
        text, self._rest = self._rest[:int(size)], self._rest[int(size):]
        return json.loads(text)

    def _take(self):
        part = self._socket.recv(1 << 20)
        if not part:
            raise RuntimeError("the browser has ended")
        self._rest += part

    def call(self, method, **params):
        self._count += 1
        text = json.dumps([0, self._count, method, params]).encode()
        self._socket.sendall(b"%d:%s" % (len(text), text))
        _, _, error, result = self._message()
        if error:
            raise RuntimeError(f"{method}: {error['message']}")
        return result

    def open(self, place):
        """A file or an http address; seconds until the page has loaded and its scripts have run."""
        start = time.monotonic()
        self.call("WebDriver:Navigate", url=place if place.startswith("http://") else "file://" + os.path.abspath(place))
        return time.monotonic() - start

    def value(self, expression):
        """Of an expression of the page; a promise is waited for."""
        script = """const [text, done] = arguments;
            window.eval('(async () => JSON.stringify({value: await (' + text + ')}))()').then(done, error => done(JSON.stringify({error: String(error)})))"""
        result = json.loads(self.call("WebDriver:ExecuteAsyncScript", script=script, args=[expression], scriptTimeout=60000, sandbox=None)["value"])
        if "error" in result:
            raise RuntimeError(result["error"])
        return result.get("value")

    @property
    def complaints(self):
        """Errors on the console of pages from disk or of this machine, and what pages have fetched from elsewhere."""
        self.call("Marionette:SetContext", value="chrome")
        found = self.call("WebDriver:ExecuteScript", args=[], script="""return Services.console.getMessageArray()
            .filter(m => m instanceof Ci.nsIScriptError && !(m.flags & Ci.nsIScriptError.warningFlag) && /^(file|http):/.test(m.sourceName))
            .map(m => m.errorMessage)""")["value"]
        self.call("Marionette:SetContext", value="content")
        fetched = self.value("performance.getEntriesByType('resource').map(r => r.name).filter(name => !name.startsWith('data:'))")
        return found + ["fetched " + name for name in fetched]

    def _act(self, kind, actions, **more):
        self.call("WebDriver:PerformActions", actions=[{"type": kind, "id": kind, "actions": actions, **more}])

    def move(self, x, y, *then):
        self._act("pointer", [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0}, *then], parameters={"pointerType": "mouse"})

    def click(self, x, y):
        self.move(x, y, {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0})

    def key(self, key, text=None):
        value = text or KEYS.get(key, key)
        self._act("key", [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}])

    def paper(self):
        """The page as it is printed on A4: a PDF."""
        return base64.b64decode(self.call("WebDriver:Print", background=True, page={"width": 21.0, "height": 29.7})["value"])

    def picture(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("WebDriver:TakeScreenshot", full=False)["value"]))
