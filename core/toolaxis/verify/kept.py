"""What is made of faces and kept from one operation to the next, the last used first, in a bounded number of bytes."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar

Made = TypeVar("Made")


class SizedCache(Generic[Made]):
    """Things by their keys, no more of them than a number of bytes.

    Parameters
    ----------
    most : int
        Bytes that are kept; the thing used last is kept however large it is.
    size_of : callable
        Bytes of a thing.
    """

    def __init__(self, most: int, size_of: Callable[[Made], int]) -> None:
        self._most, self._size_of = most, size_of
        self._held: OrderedDict[Hashable, Made] = OrderedDict()
        self._bytes = 0
        self._lock = Lock()

    def get(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What is kept under a key, made now where nothing is.

        Parameters
        ----------
        key : hashable
        make : callable
        """
        with self._lock:
            if key in self._held:
                self._held.move_to_end(key)
                return self._held[key]
        made = make()
        with self._lock:
            if key not in self._held:
                self._held[key] = made
                self._bytes += self._size_of(made)
            while self._bytes > self._most and len(self._held) > 1:
                _, gone = self._held.popitem(last=False)
                self._bytes -= self._size_of(gone)
        return made
