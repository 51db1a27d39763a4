#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""What an operator does, in LinuxCNC's place of a user interface: each step says what is wrong."""
import sys
import time

import linuxcnc

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()


def poll():
    status.poll()
    while True:
        message = errors.poll()
        if not message:
            return
        print("error: LinuxCNC says:", message[1], flush=True)


def wait(what, condition, seconds=60.0):
    until = time.time() + seconds
    while time.time() < until:
        poll()
        if condition():
            return
        time.sleep(0.01)
    print("error: not within", seconds, "s:", what, flush=True)


def expect(what, condition):
    if not condition:
        print("error:", what, flush=True)


def place():
    poll()
    return status.position[:3]


def near(a, b, bound=1e-5):
    return all(abs(p - q) <= bound for p, q in zip(a, b))


def idle():
    return status.interp_state == linuxcnc.INTERP_IDLE and status.inpos and status.queue == 0


def rests():
    return status.current_vel == 0.0


def mdi(text):
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete(20)
    command.mdi(text)
    command.wait_complete(60)
    wait(text, idle)


def start():
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete(20)
    command.program_open("program.ngc")
    command.wait_complete(20)
    command.auto(linuxcnc.AUTO_RUN, 0)


def moves_past(x):
    return lambda: status.position[0] > x


command.state(linuxcnc.STATE_ESTOP_RESET)
command.state(linuxcnc.STATE_ON)
command.wait_complete(20)
command.home(-1)
wait("homing", lambda: all(status.homed[:3]))

# MDI, G92
mdi("G21 G90 F1500 G1 X5 Y0 Z0")
mdi("G92 X0")
mdi("G1 X10")
expect("G92: X is %.6f, not 15" % place()[0], near(place(), (15, 0, 0)))
mdi("G92.1 G0 X0")
expect("back at 0", near(place(), (0, 0, 0)))

# a program, paused, run backwards, forwards, to its end
start()
wait("under way", moves_past(12))
command.auto(linuxcnc.AUTO_PAUSE)
wait("rest in a pause", lambda: status.paused and rests())
held = place()
time.sleep(0.3)
expect("a pause holds", near(place(), held))
command.auto(linuxcnc.AUTO_REVERSE)
command.auto(linuxcnc.AUTO_RESUME)
wait("backwards", lambda: status.position[0] < held[0] - 5)
command.auto(linuxcnc.AUTO_PAUSE)
wait("rest backwards", lambda: status.paused and rests())
command.auto(linuxcnc.AUTO_FORWARD)
command.auto(linuxcnc.AUTO_RESUME)
wait("the program's end", idle, 120)
expect("the end is at 0", near(place(), (0, 0, 0)))
print("told: pause, backwards, forwards: ended at", place(), flush=True)

# steps
start()
wait("under way", moves_past(1))
command.auto(linuxcnc.AUTO_PAUSE)
wait("rest", lambda: status.paused and rests())
ends = []
for _ in range(3):
    before = place()
    command.auto(linuxcnc.AUTO_STEP)
    wait("a step moves", lambda: not near(status.position[:3], before, 1e-3))
    wait("a step rests", rests)
    time.sleep(0.2)
    ends.append(place())
expect("steps end at different places: %s" % ends, not near(ends[0], ends[1], 1e-3))
# the corner at (20, 0, 1) is rounded within 0.01 mm
expect("the first step ends at its corner: %s" % (ends[0],), near(ends[0], (20, 0, 1), 0.011))
command.auto(linuxcnc.AUTO_RESUME)
wait("the end behind steps", idle, 120)
expect("the end is at 0", near(place(), (0, 0, 0)))
print("told: steps ended at", ends, flush=True)

# an abort in mid-motion
start()
wait("under way", moves_past(5))
command.abort()
wait("rest behind an abort", lambda: rests() and status.inpos and status.queue == 0)
print("told: abort at", place(), flush=True)

# a jog, and MDI from there
command.mode(linuxcnc.MODE_MANUAL)
command.wait_complete(20)
command.teleop_enable(1)
command.wait_complete(20)
before = place()
command.jog(linuxcnc.JOG_CONTINUOUS, False, 1, 10.0)
wait("a jog moves", lambda: status.position[1] > before[1] + 2)
command.jog(linuxcnc.JOG_STOP, False, 1)
wait("a jog rests", lambda: status.inpos and rests())
time.sleep(0.3)
mdi("G0 X0 Y0 Z0")
expect("back at 0 behind a jog", near(place(), (0, 0, 0)))
time.sleep(0.5)
poll()
print("done", flush=True)
sys.exit(0)
