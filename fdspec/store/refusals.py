"""What the system has run out of, in words: no fault of the file that was being read or written."""

from __future__ import annotations

import errno
import os
from typing import Final

_WORDS: Final = {
    errno.EMFILE: "too many files are open in this process; close some, or raise the limit (ulimit -n)",
    errno.ENFILE: "too many files are open on this machine",
    errno.ENOMEM: "not enough memory",
    errno.ENOSPC: os.strerror(errno.ENOSPC),
    errno.EDQUOT: os.strerror(errno.EDQUOT),
    errno.EROFS: os.strerror(errno.EROFS),
    errno.EACCES: os.strerror(errno.EACCES),
    errno.EPERM: os.strerror(errno.EPERM),
    errno.ENAMETOOLONG: "the name is too long",
    errno.ELOOP: "its symbolic links lead in a circle",
}


def no_resources(error: BaseException | None) -> str:
    """Say what was lacking; empty where it is nothing of the kind."""
    while error is not None:
        if isinstance(error, MemoryError):
            return _WORDS[errno.ENOMEM]
        if isinstance(error, OSError) and error.errno in _WORDS:
            return _WORDS[error.errno]
        error = error.__cause__ or error.__context__
    return ""
