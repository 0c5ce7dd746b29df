#!/usr/bin/env python3
"""Runs a command as the foreground job of a session whose controlling terminal is the standard input, as an interactive
shell does; exits as a shell would. The caller makes it the leader of a session of its own.

usage: terminal_job.py COMMAND ARGUMENT...

Only a job whose parent is in the same session, but in another process group, can be suspended by its terminal.
"""

import fcntl
import os
import signal
import sys
import termios


def run_in_foreground(command):
    """Runs in the child. A process that is not yet in the foreground may set it only if it ignores SIGTTOU."""
    os.setpgid(0, 0)
    signal.signal(signal.SIGTTOU, signal.SIG_IGN)
    os.tcsetpgrp(0, os.getpid())
    signal.signal(signal.SIGTTOU, signal.SIG_DFL)
    os.execv(command[0], command)


def main(command):
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    job = os.fork()
    if job == 0:
        run_in_foreground(command)
    for number in (signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, lambda number, _: os.kill(job, number))
    code = os.waitstatus_to_exitcode(os.waitpid(job, 0)[1])
    return 128 - code if code < 0 else code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
