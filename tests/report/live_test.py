"""cncplan_simulate --serve, by HTTP and in a real browser: live_test.py SIMULATE EXAMPLES CASE [PICTURE]"""

import json
import math
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

SIMULATE, EXAMPLES = sys.argv[1:3]
PROGRAM = b"G21 G90 G17 F1800\nG1 X40\nG3 X50 Y10 R10\nG0 Y40\nG1 X0\nG1 Y0\n"
FEED, AMAX, PERIOD = 30.0, 1000.0, 0.001


def check(holds, text):
    if not holds:
        raise AssertionError(text)


class Served:
    """A program that is served at a free port of this machine."""

    def __init__(self, *options, program=PROGRAM):
        self.folder = tempfile.TemporaryDirectory(prefix="cncplan-live-")
        self.path = os.path.join(self.folder.name, "part.ngc")
        with open(self.path, "wb") as file:
            file.write(program)
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

    def raw(self, text):
        """The answer's first line and its body, of a request as it is written here."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=4) as connection:
            connection.sendall(text.replace("\n", "\r\n").encode())
            answer = b""
            while b"\r\n\r\n" not in answer or (b" 400 " in answer and not answer.endswith(b"\n\n") and b"no request" not in answer):
                got = connection.recv(4096)
                if not got:
                    break
                answer += got
        head, _, body = answer.decode().partition("\r\n\r\n")
        return head.split("\r\n")[0], body

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
        # A request says all in its address: it goes with a body, without one, and without a word of it.
        for length in ("", "Content-Length: 0\n"):
            status, _ = served.raw(f"POST /ask/feed?value=0.5 HTTP/1.1\nHost: here\n{length}Connection: close\n\n")
            check(" 204 " in status, f"without a body: {status}")
        status, _ = served.raw("POST /ask/feed?value=1 HTTP/1.1\nHost: here\nContent-Length: 3\nConnection: close\n\nabc")
        check(" 204 " in status, f"with a body: {status}")
        status, body = served.raw("POST /ask/fly HTTP/1.1\nHost: here\nConnection: close\n\n")
        check(" 400 " in status and "no request 'fly'" in body, f"an unknown request: {status} {body}")
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
        if len(sys.argv) > 4:
            page.picture(sys.argv[4])


def levels():
    """Each level of smoothing, by the option that a plan has: the higher one is the faster one."""
    took = {}
    program = b"G1 X4 F1800\n" + b"".join(b"G91 X1 Y%d\n" % (1 - 2 * (i % 2)) for i in range(60)) + b"G90 X0\n"
    for level in ("fast", "good", "best"):
        with Served("--tolerance", "0.05", "--smooth", level, program=program) as served:
            rows = drive(served, "XYZ")
            check_rates(rows, "XYZ", corners=0)
            check(max(map(abs, rows[-1][0])) < 1e-9, f"it ends at {rows[-1][0]}")
            took[level] = PERIOD * len({tool[0] for tool, _, _ in rows})
    check(took["best"] <= took["good"] < took["fast"], f"the levels take {took} s")
    run = subprocess.run([SIMULATE, os.devnull, "--serve=0", "--smooth=good", "--tolerance=0"], capture_output=True, text=True, timeout=60)
    check(run.returncode == 2 and run.stderr == "error: --smooth goes with a --tolerance above 0\n", f"{run.returncode} {run.stderr}")


def machine(name):
    return os.path.join(EXAMPLES, "machines", name + ".toml")


def drive(served, axes):
    """Runs to the end; the rows, each as the tool's place and dictionaries of position and velocity by axis."""
    begin = time.monotonic()
    check(served.ask("resume") == 204, "resume is refused")
    took = time.monotonic() - begin
    check(took < 1, f"a request waits for {took} s")  # for no plan
    result = []
    for row in served.rows(30, "finished")[0]:
        check(len(row) == 9 + 4 * len(axes), f"a row of {len(axes)} axes has {len(row)} values")
        result.append((row[6:9], dict(zip(axes, row[9::4])), dict(zip(axes, row[10::4]))))
    check(len(result) > 100, f"there are {len(result)} rows")
    return result


def drive_again(served, axes):
    """The same of a run that has begun, once more from its start."""
    served.ask("stop")
    served.rows(5, "finished")
    served.ask("again")
    served.rows(2, "held")
    return drive(served, axes)


def check_rates(rows, axes, corners=2):
    """An axis goes as fast as its places say: half the sum of two velocities, but where a corner lies between."""
    for axis in axes:
        fastest = max(abs(velocity[axis]) for _, _, velocity in rows)
        gaps = sorted(abs((b[1][axis] - a[1][axis]) / PERIOD - (a[2][axis] + b[2][axis]) / 2)
                      for a, b in zip(rows, rows[1:]) if a[1] != b[1])
        check(gaps[-1 - corners] < 0.002 * fastest + 1e-9,
              f"axis {axis} goes at up to {fastest}, and {gaps[-5:]} beside its places")


def four_axes():
    """A mill with a rotary axis beside X, Y and Z."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        for letter in "XYZA":
            file.write(f'[[axis]]\nletter = "{letter}"\nkind = "{"rotary" if letter == "A" else "linear"}"\n')
        file.flush()
        with Served("--machine", file.name, program=b"G1 X10 A90 F1800\nG2 X20 Y10 I10 A120\nG0 A0 Z5\n") as served:
            rows = drive(served, "XYZA")
            check_rates(rows, "XYZA")
            for tool, place, _ in rows:
                check(all(abs(tool[k] - place["XYZ"[k]]) < 1e-9 for k in range(3)), f"the tool is at {tool}, the axes at {place}")
            check(abs(max(place["A"] for _, place, _ in rows) - 120) < 0.2, "A does not reach 120 degrees")
            check(max(abs(rows[-1][1][k] - end) for k, end in {"X": 20, "Y": 10, "Z": 5, "A": 0}.items()) < 1e-9, f"it ends at {rows[-1]}")


def check_page(served, axes):
    """The page has charts of each axis, and the cursor follows."""
    with Browser() as page:
        page.open(served.url)
        check(page.value("typeof cncplan") == "object", f"the scripts have not run: {page.complaints}")
        served.ask("resume")
        end = time.monotonic() + 10
        while not page.value("cncplan.time() > 0.2"):
            check(time.monotonic() < end, "the cursor does not follow")
            time.sleep(0.05)
        labels = page.value("cncplan.live.charts.charts[1].graph.getLabels()")
        check(labels == ["x", *axes], f"the chart of velocities has {labels}")
        gap = page.value("""(() => { const now = cncplan.live.motion.at(), of = cncplan.motions[0].at(cncplan.motions[0].timeAtLength(now.s));
            return Math.hypot(...[0, 1, 2].map(k => of.position[k] - now.tool[k])); })()""")
        check(gap < 1e-6, f"the tool is {gap} mm from where the plan has it at that length")
        elsewhere = [text for text in page.complaints if not text.startswith("fetched " + served.url)]
        check(not elsewhere, f"the console says {elsewhere}")


def table():
    """A slide and a rotary table, driven by X, Y and Z."""
    with Served("--machine", machine("kk22"), program=b"G1 X40 F1800\nG3 X50 Y10 R10\nG1 Y30 Z2\n") as served:
        check_page(served, "YZC")
        rows = drive_again(served, "YZC")
        check_rates(rows, "YZC")
        for tool, place, _ in rows:  # the table's centre is at X -150
            angle = math.radians(place["C"])
            seen = (place["Y"] * math.cos(angle) - 150, place["Y"] * math.sin(angle), place["Z"])
            check(math.dist(seen, tool) < 1e-9, f"the tool is at {tool}, the axes put it at {seen}")
        check(math.dist(rows[-1][0], (50, 30, 2)) < 1e-9, f"it ends at {rows[-1][0]}")


def five_axes():
    """A table that tilts and turns, driven by its tip at the level good."""
    with Served("--machine", machine("table_table_ac"), program=b"F3000\nG43.4\nG1 X20\nY10 A-10 C15\nX0 Y20 A-15 C40\n") as served:
        check_page(served, "XYZAC")
        rows = drive_again(served, "XYZAC")
        check_rates(rows, "XYZAC", corners=0)
        check(math.dist(rows[-1][0], (0, 20, 0)) < 1e-9, f"it ends at {rows[-1][0]}")
        check(abs(rows[-1][1]["A"] + 15) < 1e-9 and abs(rows[-1][1]["C"] - 40) < 1e-9, f"it ends at {rows[-1]}")


def rows_of_axes():
    """Rows of R, Z, A, C, as cncplan_tire_mold writes them."""
    length = 20.0
    with Served("--machine", machine("tire_mold"), "--tool-length", str(length),
                program=b"G0 R200 Z100 A-10 C0\nG1 R205 Z102 A-12 C10 F1800\nG1 R205 Z102 A-5 C10\n") as served:
        rows = drive(served, "RZAC")
        check_rates(rows, "RZAC")
        for tool, place, _ in rows:
            tilt, turn = math.radians(place["A"]), math.radians(place["C"])
            radius = place["R"] + length * math.sin(tilt)
            seen = (radius * math.cos(turn), radius * math.sin(turn), place["Z"] - length * math.cos(tilt))
            check(math.dist(seen, tool) < 1e-9, f"the tip is at {tool}, the axes put it at {seen}")
        check(abs(rows[-1][1]["A"] + 5) < 1e-9 and abs(rows[-1][1]["C"] - 10) < 1e-9, f"it ends at {rows[-1][1]}")


CASES = {"http": http, "refusals": refusals, "levels": levels, "browser": browser, "four axes": four_axes, "table": table, "rows": rows_of_axes,
         "five axes": five_axes}
CASES[sys.argv[3]]()
print(f"{sys.argv[3]}: passed")
