"""Runs a command for so long at most, and measures it."""

import os
import subprocess
import tempfile
import time
import typing


class Ran(typing.NamedTuple):
    code: typing.Optional[int]  # None: it was stopped
    said: str                   # standard output and errors
    seconds: float              # of processor time
    wall: float                 # seconds
    memory: int                 # bytes, at its height


def limited_run(command, limit):
    """A Ran of a command that is killed after `limit` seconds."""
    with tempfile.TemporaryFile() as said:
        begin = time.monotonic()
        process = subprocess.Popen([str(word) for word in command], stdout=said, stderr=subprocess.STDOUT)
        is_stopped = False
        while True:
            pid, status, usage = os.wait4(process.pid, 0 if is_stopped else os.WNOHANG)
            if pid:
                break
            if time.monotonic() - begin > limit:
                process.kill()
                is_stopped = True
            else:
                time.sleep(0.005)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return Ran(None if is_stopped and process.returncode < 0 else process.returncode, said.read().decode(errors="replace"),
                   usage.ru_utime + usage.ru_stime, time.monotonic() - begin, 1024 * usage.ru_maxrss)
