"""cncplan_simulate --serve, by HTTP and in a real browser: live_test.py SIMULATE CASE..."""

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

from browser import Browser

SIMULATE = sys.argv[1]
PROGRAM = b"G21 G90 G17 F1800\nG1 X40\nG3 X50 Y10 R10\nG0 Y40\nG1 X0\nG1 Y0\n"
FEED, AMAX, PERIOD = 30.0, 1000.0, 0.001


def check(holds, text):
    if not holds:
        raise AssertionError(text)


class Served:
    """A program that is served at a free port of this machine."""

    def __init__(self, *options):
        self.folder = tempfile.TemporaryDirectory(prefix="cncplan-live-")
        self.path = os.path.join(self.folder.name, "part.ngc")
        with open(self.path, "wb") as file:
            file.write(PROGRAM)
        self.process = subprocess.Popen([SIMULATE, self.path, "--serve", "0", *options], stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        check(self.url.startswith("http://127.0.0.1:"), f"it says it is at '{self.url}'")
        self.port = int(self.url.rstrip("/").rsplit(":", 1)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(10)
        finally:
            self.process.kill()
            self.process.stdout.close()
            self.folder.cleanup()

    def get(self, path=""):
        with urllib.request.urlopen(self.url + path, timeout=5) as answer:
            return answer.read().decode()

    def ask(self, what, **headers):
        """The status of the answer."""
        request = urllib.request.Request(self.url + "ask/" + what, method="POST", data=b"", headers=headers)
        try:
            with urllib.request.urlopen(request, timeout=5) as answer:
                return answer.status
        except urllib.error.HTTPError as error:
            return error.code

    def rows(self, seconds, until=None):
        """Rows of so many seconds, or until a state; and the last answer."""
        rows, end = [], time.monotonic() + seconds
        after = getattr(self, "after", 0)
        while True:
            answer = json.loads(self.get(f"rows?after={after}"))
            rows += answer["rows"]
            after = self.after = answer["next"]
            if time.monotonic() > end or answer["state"] == until:
                check(until is None or answer["state"] == until, f"it is {answer['state']}, not {until}, after {seconds} s")
                return rows, answer
            time.sleep(0.02)


def http():
    with Served() as served:
        page = served.get()
        check("</html>" in page and "G3 X50 Y10 R10" in page, "the page does not hold the program")
        answer = served.rows(0.2)[1]
        check(answer["state"] == "held", f"it begins {answer['state']}")
        began = time.monotonic()
        check(served.ask("resume") == 204, "resume is refused")
        rows, answer = served.rows(0.7)
        check(answer["state"] == "moves" and rows[-1][6] > 5, f"it does not move: {rows[-1]}")
        check(served.ask("hold") == 204, "hold is refused")
        more, _ = served.rows(2, "held")
        held = more[-1]
        check(held[3] == 0 and held[2] < 40, f"held at {held}")
        check(served.rows(0.3)[0][-1][2] == held[2], "it creeps while it is held")
        check(served.ask("feed?value=0.5") == 204 and served.ask("resume") == 204, "an override is refused")
        slow, answer = served.rows(1.2)
        check(answer["feed"] == 0.5, f"the override is {answer['feed']}")
        check(abs(max(row[3] for row in slow) - 0.5 * FEED) < 1e-9, f"at half the feed it goes {max(r[3] for r in slow)}")
        check(served.ask("feed?value=2") == 204, "an override is refused")
        fast, answer = served.rows(20, "finished")
        rows = rows + more + slow + fast
        end = rows[-1]
        check(max(map(abs, end[6:9])) < 1e-9, f"the program ends at {end[6:9]}")
        took = time.monotonic() - began
        check(abs(took - (end[0] - rows[0][0])) < 2.0, f"{end[0] - rows[0][0]:.2f} s of the program took {took:.2f} s")
        for row in rows:
            check(row[3] <= FEED + 1e-9 and abs(row[4]) <= AMAX + 1e-6, f"beyond the limits: {row}")
        check(served.ask("again") == 204, "a new run is refused")
        rows, answer = served.rows(0.3)
        check(answer["run"] == 2 and answer["state"] == "held" and rows[-1][2] == 0, f"not at the start: {answer['state']}")
        served.ask("step?value=1")
        served.ask("resume")
        rows, answer = served.rows(8, "rests")
        check(abs(rows[-1][6] - 40) < 1e-9, f"a single step ends at {rows[-1][6:9]}")
        served.ask("step?value=0")
        served.ask("resume")
        served.rows(0.2)
        served.ask("stop")
        rows, answer = served.rows(3, "finished")
        check(rows[-1][3] == 0 and rows[-1][2] < 170, "a stop does not stop")


def refusals():
    with Served() as served:
        for bad in ("fly", "feed", "feed?value=3", "feed?value=x", "feed?value=-1", "rapid?value=1.5", "step?value=nan"):
            check(served.ask(bad) == 400, f"{bad} is taken")
        check(served.ask("resume", Origin="http://elsewhere.example") == 403, "another site may start it")
        check(served.rows(0.3)[1]["state"] == "held", "a refused request acts")
        for bad in ("rows", "rows?after=x", "nothing"):
            try:
                served.get(bad)
                check(False, f"{bad} is answered")
            except urllib.error.HTTPError as error:
                check(error.code in (400, 404), f"{bad}: {error.code}")
        other = subprocess.run([SIMULATE, served.path, "--serve", str(served.port)], capture_output=True, text=True, timeout=60)
        check(other.returncode == 1 and other.stderr.startswith("error: --serve: 127.0.0.1 port") and other.stderr.count("\n") == 1,
              f"a port in use: {other.returncode} {other.stderr}")
        listening = {line.split()[1] for line in open("/proc/net/tcp").read().splitlines()[1:] if line.split()[3] == "0A"}
        check([a for a in listening if int(a.split(":")[1], 16) == served.port] == [f"0100007F:{served.port:04X}"],
              "it listens to other addresses too")
        idle = socket.create_connection(("127.0.0.1", served.port))  # says nothing; must not hold up the end
        served.process.send_signal(signal.SIGINT)
        began = time.monotonic()
        check(served.process.wait(10) == 0, f"SIGINT: exit code {served.process.returncode}")
        check(time.monotonic() - began < 8, "it takes long to end")
        idle.close()
    for bad in ("", "x", "70000", "-1", ":80", "127.0.0.1:", "127.0.0.1:8x"):
        run = subprocess.run([SIMULATE, os.devnull, f"--serve={bad}"], capture_output=True, text=True, timeout=60)
        check(run.returncode == 2 and run.stderr.count("\n") == 1, f"--serve '{bad}': {run.returncode} {run.stderr}")


def browser():
    with Served("--tolerance", "0.02") as served, Browser() as page:
        page.open(served.url)
        check(page.value("typeof cncplan") == "object", f"the scripts have not run: {page.complaints}")

        def press(name):
            x, y = page.value(f"""(() => {{ const b = document.querySelector('[data-ask="{name}"]'); scrollTo(0, 0);
                b.scrollIntoView({{block: 'center'}}); const r = b.getBoundingClientRect();
                return [r.left + r.width / 2, r.top + r.height / 2]; }})()""")
            page.click(x, y)

        def wait(condition, seconds=10):
            end = time.monotonic() + seconds
            while not page.value(condition):
                check(time.monotonic() < end, f"not within {seconds} s: {condition}; {page.value('cncplan.live.state')}")
                time.sleep(0.05)

        wait("cncplan.live.state === 'held'")
        press("resume")
        wait("cncplan.live.state === 'moves' && cncplan.live.motion.at().s > 5")
        wait("cncplan.time() > 0.1 && cncplan.view.marker.tool[0] > 3")
        check(page.value("document.querySelector('.line.current')?.dataset.line") == "2", "the line that runs is not marked")
        press("hold")
        wait("cncplan.live.state === 'held'")
        page.value("(() => { const f = document.getElementById('live-feed'); f.value = 50; f.dispatchEvent(new Event('input')); })()")
        wait("document.querySelector('#live-feed + output').textContent === '50 %'")
        page.value("document.activeElement.blur()")
        page.key(" ", " ")
        wait("cncplan.live.state === 'moves'")
        charts = page.value("cncplan.live.charts.charts.map(c => c.graph.numRows())")
        check(len(charts) == 5 and min(charts) > 50, f"the charts have {charts} rows")
        press("stop")
        wait("cncplan.live.state === 'finished'")
        press("again")
        wait("cncplan.live.state === 'held' && cncplan.live.run === 2")
        elsewhere = [text for text in page.complaints if not text.startswith("fetched " + served.url)]
        check(not elsewhere, f"the console says {elsewhere}")
        if len(sys.argv) > 3:
            page.picture(sys.argv[3])


CASES = {"http": http, "refusals": refusals, "browser": browser}
CASES[sys.argv[2]]()
print(f"{sys.argv[2]}: passed")
