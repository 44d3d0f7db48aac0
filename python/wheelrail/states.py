"""Saved states of an instance: kept in memory, as bytes, in a file."""

import json
import weakref
import zlib
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from .archive import AnyPath
from .native import Phase, address

if TYPE_CHECKING:
    from .saving import Saving

MARK = b"wheelrail state 1 "


@dataclass(frozen=True)
class Contents:
    """What the bytes of a saved state hold: the component's own form, and what an instance for it is made with."""

    model: str
    version: str
    phase: str
    time: float
    parameters: dict[str, Any]
    serialised: bytes

    def to_bytes(self) -> bytes:
        """One line with a checksum, one of JSON, the component's bytes."""
        described = {name: value for name, value in vars(self).items() if name != "serialised"}
        body = json.dumps(described).encode() + b"\n" + self.serialised
        return MARK + b"%08x\n" % zlib.crc32(body) + body

    @classmethod
    def from_bytes(cls, data: bytes) -> Self:
        """Read them.

        Raises
        ------
        ValueError
            They are no saved state, or damaged.
        """
        first, _, body = data.partition(b"\n")
        if not first.startswith(MARK):
            raise ValueError("these bytes are not a saved state of wheelrail")
        if first.removeprefix(MARK) != b"%08x" % zlib.crc32(body):
            raise ValueError("the saved state is damaged: its checksum is wrong")
        described, _, serialised = body.partition(b"\n")
        try:
            contents = cls(**json.loads(described), serialised=serialised)
            contents.phase_of()
        except (TypeError, KeyError) as error:
            raise ValueError(f"the saved state is not one of this package: {error}") from None
        return contents

    def phase_of(self) -> Phase:
        """How far the instance was."""
        return Phase[self.phase]


class SavedState:
    """The state of an instance at one time, to go back to: what `Instance.save` returns.

    It is kept by the instance, and freed with it, with `Instance.forget`, or when nobody refers to it any more. As
    bytes or in a file it outlives the process; so it is pickled and copied, too.

    Attributes
    ----------
    time
        Time of the state [s].

    Examples
    --------
    >>> contact.save().write("contact.state")
    >>> contact = Instance.load("contact.state")  # in another process
    """

    def __init__(self, time: float, instance: "Saving | None", handle: Any, contents: Contents | None) -> None:
        """Of an instance, by its handle, or of no instance in this process, by contents."""
        self.time = time
        self._instance, self._handle, self._contents = instance, handle, contents
        if instance is not None:
            self._drop = weakref.finalize(self, instance.slave.dropped.append, address(handle))
            self._drop.atexit = False

    def to_bytes(self) -> bytes:
        """The state as bytes, with the parameters that an instance for it needs.

        Any instance of this version of the component with the same fixed parameters can go on from them, in another
        process and under the other version of FMI: `Instance.restore`; `Instance.load` makes such an instance.

        Raises
        ------
        SimulationError
            The FMU cannot serialise its states; InstanceClosedError: the instance that kept the state is closed.
        ValueError
            The state was forgotten.
        """
        return self._read().to_bytes()

    def write(self, path: AnyPath) -> None:
        """Write the bytes into a file.

        Raises
        ------
        OSError
            The file cannot be written.
        SimulationError, ValueError
            As `to_bytes`.
        """
        Path(path).write_bytes(self.to_bytes())

    @classmethod
    def from_bytes(cls, data: bytes | bytearray | memoryview) -> Self:
        """A state from its bytes.

        Raises
        ------
        TypeError
            They are no bytes.
        ValueError
            They are not those of a state, or damaged.
        """
        if not isinstance(data, bytes | bytearray | memoryview):
            raise TypeError(f"{data!r}: bytes are needed")
        contents = Contents.from_bytes(bytes(data))
        return cls(contents.time, None, None, contents)

    @classmethod
    def read(cls, path: AnyPath) -> Self:
        """A state from a file.

        Raises
        ------
        OSError
            The file cannot be read.
        ValueError
            It does not hold a state, or is damaged.
        """
        try:
            return cls.from_bytes(Path(path).read_bytes())
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied by its bytes."""
        return SavedState.from_bytes, (self.to_bytes(),)

    def __repr__(self) -> str:
        """Time, and where it is kept."""
        if self._instance is not None:
            kept = f"of {self._instance.name!r}"
        else:
            kept = "forgotten" if self._contents is None else "as bytes"
        return f"<wheelrail.SavedState of t = {self.time:g} s, {kept}>"

    def _of(self, instance: "Saving") -> Any:
        """The handle, where the state is one that an instance keeps; None where it is to be taken by its contents."""
        return self._handle if self._instance is instance else None

    def _read(self) -> Contents:
        """The contents: of a state that is kept by an instance, as it serialises them."""
        if self._contents is not None:
            return self._contents
        if self._instance is None:
            raise ValueError(f"the state of t = {self.time:g} s was forgotten: save another one")
        return self._instance._serialised(self._handle)

    def _forget(self) -> None:
        """Forget handle and contents."""
        if self._instance is not None:
            self._drop.detach()
        self._instance = self._handle = self._contents = None


def state_of(saved: Any) -> SavedState:
    """A saved state, given as such, as bytes, or by the path of a file.

    Raises
    ------
    TypeError
        It is none of them.
    OSError, ValueError
        As `SavedState.read`.
    """
    if isinstance(saved, SavedState):
        return saved
    if isinstance(saved, bytes | bytearray | memoryview):
        return SavedState.from_bytes(saved)
    if isinstance(saved, str | PathLike):
        return SavedState.read(saved)
    raise TypeError(f"{saved!r}: a saved state, its bytes or the path of its file is needed")
