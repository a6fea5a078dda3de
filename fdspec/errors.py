"""What can go wrong, by whose hand: every error of fdspec is one of these."""


class FdspecError(Exception):
    """Any error that fdspec raises on purpose; its text is one clear sentence."""


class InvalidInput(FdspecError, ValueError):
    """An argument, option or file content that cannot be used as it is."""


class RecordError(InvalidInput):
    """A record file or a record name that cannot be used."""


class StudyError(InvalidInput):
    """A study file with a wrong or unknown field."""


class IntegrationError(FdspecError, RuntimeError):
    """A history that ended with a status other than ok."""


class StoreError(FdspecError, OSError):
    """A cube that cannot be written or read."""


class DiskError(StoreError):
    """A disk that gave out at work: full, read-only, gone."""


class BusyError(DiskError):
    """A file or store that another process is writing."""


class DamagedError(StoreError):
    """A cube that is there, and is not what was written."""


class ClusterError(FdspecError, RuntimeError):
    """A cluster that cannot be reached, or whose workers fail."""
