"""Long work beside the interface: on a thread, with progress and Esc."""

import threading

import bpy

from .engine import Cancelled, Failure

running = None  # the operator's work under way, if there is any: one at a time


class Work:
    """`function(progress)` on a thread of its own; progress(fraction, step) is False once it is to stop."""

    def __init__(self, title, function):
        self.title = title
        self.fraction = 0.0
        self.step = ""
        self._function = function
        self._stop = threading.Event()
        self._result = None
        self._error = None
        self._thread = threading.Thread(target=self._run, name="cagewright", daemon=True)

    def start(self):
        self._thread.start()

    def stop(self):
        self._stop.set()

    @property
    def stopping(self):
        return self._stop.is_set()

    def is_finished(self):
        return not self._thread.is_alive()

    def run_here(self):
        self._run()
        return self.result()

    def result(self):
        if self._error is not None:
            raise self._error
        return self._result

    def _told(self, fraction, step):
        self.fraction, self.step = fraction, step
        return not self._stop.is_set()

    def _run(self):
        try:
            self._result = self._function(self._told)
        except Exception as error:  # told on the main thread
            self._error = error


def redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


class Working:
    """An operator that prepares, works, and finishes.

    prepare(context) returns the function that works, which sees no Blender data; finish(context, result) puts what it
    returned into the file. Both may raise Failure.
    """

    title = ""
    _timer = None

    def execute(self, context):
        """All at once, as scripts want it."""
        try:
            self.finish(context, Work(self.title, self.prepare(context)).run_here())
        except (Failure, Cancelled) as error:
            self.report({"ERROR"}, str(error) or "stopped")
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        """Beside the interface."""
        global running
        if bpy.app.background:
            return self.execute(context)
        if running is not None:
            self.report({"ERROR"}, f"{running.title} is still under way: wait for it, or cancel it")
            return {"CANCELLED"}
        try:
            running = Work(self.title, self.prepare(context))
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        running.start()
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.05, window=context.window)
        manager.modal_handler_add(self)
        context.workspace.status_text_set(f"{self.title}: Esc stops it")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            running.stop()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        redraw()
        if not running.is_finished():
            return {"RUNNING_MODAL"}
        work = self._end(context)
        try:
            self.finish(context, work.result())
        except Cancelled:
            self.report({"INFO"}, f"{self.title}: stopped")
            return {"CANCELLED"}
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        redraw()
        return {"FINISHED"}

    def cancel(self, context):
        """Blender ends the operator: another file is opened, say."""
        if running is not None:
            running.stop()
            self._end(context)

    def _end(self, context):
        global running
        work, running = running, None
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        return work
