"""The root of the exceptions of all packages, and those of this one."""


class UvmsError(Exception):
    """Root of every error that this project raises on purpose; its text is written for users."""


class VehicleFileError(UvmsError):
    """A vehicle file is missing, unreadable or names a value that is not allowed."""


class ConfigError(UvmsError):
    """A configuration value is unknown or outside its bounds."""


class PluginError(UvmsError):
    """A part that is chosen by name is unknown, cannot be imported or does not fit."""


class SignalError(UvmsError):
    """A signal has a wrong shape, frame or stamp, or a value that is not finite."""


class StaleError(SignalError):
    """A signal is too old to be used at this tick; a newer one may be used again."""


class ImplausibleError(SignalError):
    """A signal has a value, or a jump from the one before, that this vehicle cannot have."""


class StampError(SignalError):
    """A stamp is far from the time that the node's other inputs agree on."""


class UnsafeOutputError(UvmsError):
    """A part made an output that is not finite or not possible; it is not published."""


class DefinitionError(UvmsError):
    """A message type is not installed, or its definition cannot be read."""


class CdrError(UvmsError):
    """Bytes are not a message of the type, or values do not fit it."""


class PlantDiverged(UvmsError):  # noqa: N818 (an event of the simulation rather than a fault)
    """The plant's state is not finite any more; names the stamp and the state."""
