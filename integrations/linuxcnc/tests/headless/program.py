#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs one program to its end, in LinuxCNC's place of a user interface."""
import sys
import time

import linuxcnc

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
command.state(linuxcnc.STATE_ESTOP_RESET)
command.state(linuxcnc.STATE_ON)
command.wait_complete(20)
command.home(-1)
while True:
    status.poll()
    if all(status.homed[:3]):
        break
    time.sleep(0.05)
command.mode(linuxcnc.MODE_AUTO)
command.wait_complete(20)
command.program_open("program.ngc")
command.wait_complete(20)
command.auto(linuxcnc.AUTO_RUN, 0)


def taken():
    """Whether task has taken the last command: until then what it shows is of the time before."""
    return status.echo_serial_number == command.serial


def ended():
    return (
        status.state != linuxcnc.RCS_EXEC
        and status.interp_state == linuxcnc.INTERP_IDLE
        and status.queue == 0
        and status.inpos
    )


def tell_messages():
    while message := errors.poll():
        # what the program itself says is no error
        wrong = message[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR)
        print("error: LinuxCNC says:" if wrong else "told:", message[1], flush=True)


while True:
    status.poll()
    tell_messages()
    if taken():
        if ended():
            break
        if status.interp_state == linuxcnc.INTERP_PAUSED:
            command.auto(linuxcnc.AUTO_RESUME)  # M0, M1, M6
    time.sleep(0.05)
time.sleep(0.5)
tell_messages()
print("done at", status.position[:3], flush=True)
sys.exit(0)
