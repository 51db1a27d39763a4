"""How fast reports are: speed.py REPORT.html... Prints figures and judges nothing.

A page is opened five times, and turned for five seconds by a pointer that drags. Processor time is that of all of the
browser's processes: it tells more than the clock where the machine has other work to do."""

import os
import sys
import time

from browser import Browser

OPENED, SECONDS = 5, 5.0


def read(path):
    """Empty where the process has just ended."""
    try:
        with open(path) as file:
            return file.read()
    except OSError:
        return ""


def processes(first):
    """A process, those that it has started, and those that these have."""
    yield first
    for task in os.listdir(f"/proc/{first}/task") if os.path.isdir(f"/proc/{first}/task") else []:
        for child in read(f"/proc/{first}/task/{task}/children").split():
            yield from processes(int(child))


def processor_seconds(browser):
    """By kind of process: renderer (the page's scripts and layout), gpu-process (its pictures), others."""
    result = {}
    for process in processes(browser.process.pid):
        words, status = read(f"/proc/{process}/cmdline").replace("\0", " ").split(), read(f"/proc/{process}/stat")
        if not status:
            continue
        kind = next((w[7:] for w in words if w.startswith("--type=")), "browser")
        result[kind] = result.get(kind, 0.0) + sum(map(int, status.rsplit(")", 1)[1].split()[11:13])) / os.sysconf("SC_CLK_TCK")
    return result


def turn(page):
    """Frames a second while the view is dragged, and ms of processor time for each by kind of process."""
    x, y, width, height = page.value("""(() => { const v = document.getElementById('view'); v.scrollIntoView({block: 'center'});
        const b = v.getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()""")
    page.value("""(() => { const view = cncplan.view, draw = view.draw.bind(view); window.frames_drawn = 0;
        view.draw = () => { draw(); ++window.frames_drawn; }; })()""")

    def mouse(kind, dx):
        page.call("Input.dispatchMouseEvent", type=kind, x=x + width / 2 + dx, y=y + height / 2, button="left", buttons=1, clickCount=1)

    mouse("mousePressed", 0)
    mouse("mouseMoved", 5)
    before, start, first = processor_seconds(page), time.monotonic(), page.value("window.frames_drawn")
    step = 0
    while time.monotonic() < start + SECONDS:
        step += 1
        mouse("mouseMoved", 5 + step % 100)
    seconds, count = time.monotonic() - start, page.value("window.frames_drawn") - first
    after = processor_seconds(page)
    mouse("mouseReleased", 5)
    return count / seconds, {kind: 1000 * (after[kind] - before.get(kind, 0.0)) / max(count, 1) for kind in after}


def kinds(times, unit):
    return ", ".join(f"{kind} {value:.1f} {unit}" for kind, value in sorted(times.items()) if value >= 0.05)


for path in sys.argv[1:]:
    print(f"{path}: {os.path.getsize(path) / 1e6:.1f} MB, load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    for k in range(OPENED):
        with Browser() as page:
            before = processor_seconds(page)
            seconds = page.open(path)
            page.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
            after = processor_seconds(page)
            spent = {kind: after[kind] - before.get(kind, 0.0) for kind in after}
            print(f"  opened in {seconds:.2f} s; processor time {kinds(spent, 's')}")
            if k + 1 == OPENED:
                rate, times = turn(page)
                print(f"  turns at {rate:.1f} frames/s; processor time of a frame {kinds(times, 'ms')}")
