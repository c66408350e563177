"""Any log with ROS 2 messages: MCAP or SQLite, a file or the folder of a bag."""

from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from uvms_analysis.errors import LogError
from uvms_analysis.log.definition import log_codec
from uvms_analysis.log.locate import log_path
from uvms_analysis.log.read import RunLog
from uvms_core.cdr import DefinitionError, codec, stamp_in

MCAP, SQLITE = ".mcap", ".db3"


class Raw(NamedTuple):
    """A message as it was recorded."""

    topic: str
    logged: int  # ns, when it was recorded
    data: bytes

    @property
    def stamp(self) -> int | None:
        """That of its header, ns; None where there is none."""
        return stamp_in(self.data)


class Bag:
    """Topics and messages of a log.

    Args:
        path: as given.
        types: type of each topic by its full name.
        counts: number of messages by topic.
        read: gives the messages of some topics in the order of the file.
        decoder: of a topic, from bytes to a message-like object.
        run: the same as a log of this system; None where the file is no MCAP.
    """

    def __init__(
        self,
        path: Path,
        types: dict[str, str],
        counts: dict[str, int],
        read: Callable[[Collection[str]], Iterator[Raw]],
        decoder: Callable[[str], Callable[[bytes], Any]],
        run: RunLog | None = None,
    ) -> None:
        self.path, self.types, self.counts, self.run = path, types, counts, run
        self.messages, self.decoder = read, decoder

    @property
    def fault(self) -> str:
        """Why the log is incomplete; empty where it is whole."""
        return self.run.fault if self.run is not None else ""

    @property
    def is_ours(self) -> bool:
        """Whether it is the log of a run of this system, with its configuration and vehicle."""
        run = self.run
        return run is not None and {"config.yaml", "vehicle.yaml"} <= set(run.attachments)

    def of_type(self, *types: str) -> list[str]:
        """Topics with messages of one of these types, sorted."""
        return sorted(name for name, one in self.types.items() if one in types)


def open_bag(path: str | Path) -> Bag:
    """The log of a file or of a folder.

    Raises:
        LogError: there is none, or it cannot be read.
    """
    path = Path(path)
    if not path.exists():
        raise LogError(f"log {path}: no such file or folder")
    if path.is_dir() and list(path.glob(f"*{SQLITE}")):
        return _sqlite_bag(path)
    if path.suffix == SQLITE:
        return _sqlite_bag(path)
    return _mcap_bag(log_path(path))


def _mcap_bag(path: Path) -> Bag:
    """By the reader of our own logs, which also takes what is cut off or damaged in part."""
    run = RunLog.open(path)

    def read(names: Collection[str]) -> Iterator[Raw]:
        for name, entry in run.entries(list(names)):
            yield Raw(name, entry.stamp, entry.data)

    def decoder(name: str) -> Callable[[bytes], Any]:
        try:
            return run.codec(name).decode
        except LogError:  # written in IDL, say
            return _installed(path, name, run.topics[name])

    return Bag(path, run.topics, run.counts, read, decoder, run)


def _sqlite_bag(path: Path) -> Bag:
    from rosbags.rosbag2 import Reader, ReaderError

    def opened() -> Any:
        try:
            reader = Reader(path)
            reader.open()
        except (ReaderError, OSError) as fault:
            raise LogError(f"log {path}: cannot be read: {fault}") from fault
        return reader

    reader = opened()
    types = {one.topic: one.msgtype for one in reader.connections}
    counts = {one.topic: one.msgcount for one in reader.connections}
    definitions = {one.topic: _definition(one) for one in reader.connections}
    reader.close()

    def read(names: Collection[str]) -> Iterator[Raw]:
        reader = opened()
        try:
            wanted = [one for one in reader.connections if one.topic in names]
            for connection, logged, data in reader.messages(wanted) if wanted else ():
                yield Raw(connection.topic, logged, bytes(data))
        except ReaderError as fault:
            raise LogError(f"log {path}: is damaged: {fault}") from fault
        finally:
            reader.close()

    def decoder(name: str) -> Callable[[bytes], Any]:
        if (text := definitions[name]) is None:
            return _installed(path, name, types[name])
        return log_codec(f"log {path}: {name}", types[name], text).decode

    return Bag(path, types, counts, read, decoder)


def _definition(connection: Any) -> bytes | None:
    """That of a topic's messages where the bag has it, as bags have since ROS 2 Iron."""
    found = connection.msgdef
    is_text = found.format.name == "MSG" and found.data
    return str(found.data).encode() if is_text else None


def _installed(path: Path, name: str, type_name: str) -> Callable[[bytes], Any]:
    try:
        return codec(type_name).decode
    except DefinitionError as fault:
        raise LogError(
            f"log {path}: {name}: the log has no definition of its messages, and {fault}"
        ) from fault
