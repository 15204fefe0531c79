"""Long calls: on another thread, so that Ctrl-C is heard and progress is told where the caller is."""

import collections
import ctypes
import operator
import threading

from ._library import Control, Handle, Report, checked, lib
from .errors import Cancelled

_MOST_THREADS = 1024  # more make no difference
_PATIENCE = 0.4  # seconds that a call gets to stop before Ctrl-C is answered without it
_MOMENT = 0.1  # seconds


def control(threads):
    """How a quick call runs."""
    return Control(size=ctypes.sizeof(Control), threads=_count(threads))


def _count(threads):
    if threads is None:
        return 0
    try:
        number = operator.index(threads)
    except TypeError:
        number = 0
    if number < 1:
        raise ValueError(f"threads: {threads!r} is not a number of threads; give 1 or more, or None for all cores")
    return min(number, _MOST_THREADS)


def whole_number(value, what, least=0):
    """An integer of any type, for the library."""
    try:
        number = operator.index(value)
    except TypeError:
        raise ValueError(f"{what}: {value!r} is not a whole number") from None
    if not least <= number < 2**31:
        raise ValueError(f"{what}: {value!r} is not from {least} on")
    return number


class _Call:
    """One run of a function of the library: `work(control)` on a thread of its own."""

    def __init__(self, work, threads, wants_progress):
        self._work = work
        self._changed = threading.Condition()
        self._reports = collections.deque()
        self._finished = False
        self._result = None
        self._error = None
        self._stop = Handle(lib.cw_stop_new(), lib.cw_stop_free)
        self._report = Report(self._told) if wants_progress else Report()
        self._control = Control(size=ctypes.sizeof(Control), threads=_count(threads), report=self._report,
                                stop=self._stop.pointer)

    def start(self):
        threading.Thread(target=self._run, name="cagewright", daemon=True).start()

    def stop(self):
        lib.cw_stop_request(self._stop.pointer)

    def wait(self, timeout=None):
        # A signal that comes just before a thread waits for ever does not wake it: the waits are short ones.
        with self._changed:
            while timeout is None and not self._finished:
                self._changed.wait(_MOMENT)
            return self._changed.wait_for(lambda: self._finished, timeout)

    def reports(self):
        """What is told, as it comes, to the end of the call."""
        while True:
            with self._changed:
                while not (self._finished or self._reports):
                    self._changed.wait(_MOMENT)
                if not self._reports:
                    return
                report = self._reports.popleft()
            yield report

    def result(self):
        if self._error is not None:
            raise self._error
        return self._result

    def _run(self):
        try:
            self._result = self._work(self._control)
        except BaseException as error:  # raised where the caller waits
            self._error = error
        with self._changed:
            self._finished = True
            self._changed.notify_all()

    def _told(self, _user, fraction, step):
        with self._changed:
            self._reports.append((fraction, step.decode("utf-8", "replace")))
            self._changed.notify_all()
        return 0


def run(work, threads, progress):
    """Runs `work(control)`, which calls the library, and returns its result.

    Whatever is raised while we wait, KeyboardInterrupt above all, stops the work. `progress(fraction, step)` is called
    on the thread of the caller; where it returns False the work stops, and Cancelled is raised.
    """
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: {progress!r} cannot be called; give a function of a fraction and a step, or None")
    call = _Call(work, threads, progress is not None)
    call.start()
    try:
        if progress is None:
            call.wait()
        else:
            for fraction, step in call.reports():
                if progress(fraction, step) is False:
                    call.stop()
                    break
            call.wait()
    except BaseException:
        call.stop()
        call.wait(_PATIENCE)
        raise
    return call.result()


__all__ = ["Cancelled", "checked", "control", "run", "whole_number"]
