"""What can go wrong. Every exception carries the library's sentence, and `.code`, its short name."""


class Error(Exception):
    """The base of all: `code` is one of the names below, such as "unfit_model"."""

    code = "internal"


class FileError(Error, OSError):
    """A file cannot be opened or written (cannot_open, cannot_write)."""


class InputError(Error, ValueError):
    """What was given makes no sense: malformed, unsupported, unfit_model, invalid_cage, invalid_option, mismatch."""


class NoValidCage(Error, RuntimeError):
    """No cage was found that passes the exact check (no_valid_cage)."""


class TooLarge(Error, MemoryError):
    """More memory or larger indices are needed than there are (too_large)."""


class NotAvailable(Error, RuntimeError):
    """The machine or this build lacks something (not_available)."""


class Cancelled(Error):
    """The call was asked to stop: `progress` returned False (cancelled)."""


class NotAsAsked(UserWarning):
    """The cage is valid, but not all that was asked for holds; the message says what."""


_CLASSES = {"cannot_open": FileError, "cannot_write": FileError, "no_valid_cage": NoValidCage, "too_large": TooLarge,
            "not_available": NotAvailable, "cancelled": Cancelled, "internal": Error}


def error_of(code, message):
    error = _CLASSES.get(code, InputError)(message)
    error.code = code
    return error
