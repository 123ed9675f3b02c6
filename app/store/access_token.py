"""The token that a server asks for where other machines can reach it; only its hash is kept.

A token has 256 random bits, so one round of SHA-256 is enough: there is nothing to guess.
"""

import hashlib
import hmac
import json
import os
import secrets
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from app.store.durable_file import write_at_once
from app.store.storage_error import storing
from planner.errors import FoldingError

SHORTEST = 20
"""Least length of a token from a file (characters)."""

_BYTES = 32
_PRIVATE = 0o600


@dataclass
class WeakTokenError(FoldingError):
    """A file's token is too short."""

    path: Path

    def __str__(self) -> str:
        return f"{self.path}: the token should have at least {SHORTEST} characters"


@dataclass(frozen=True, slots=True)
class AccessToken:
    """What the server keeps of a token.

    Attributes:
        digest: its SHA-256.
    """

    digest: bytes

    def matches(self, given: str) -> bool:
        """Return whether this is the token, in a time that does not depend on it."""
        return hmac.compare_digest(_digest(given), self.digest)


def file_token(path: Path) -> AccessToken:
    """Return the token in a file; make a file that only its owner can read, with a new token, if there is none.

    Raises:
        WeakTokenError: the token is too short.
        StorageError: the file cannot be read or made.
    """
    with storing(f"{path} cannot be used"):
        with suppress(FileExistsError):
            descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, _PRIVATE)
            with os.fdopen(descriptor, "w", encoding="ascii") as file:
                file.write(f"{secrets.token_urlsafe(_BYTES)}\n")
        token = path.read_text(encoding="utf-8").strip()
    if len(token) < SHORTEST:
        raise WeakTokenError(path)
    return AccessToken(_digest(token))


def kept_token(path: Path, *, is_new: bool = False) -> tuple[AccessToken, str | None]:
    """Return the token whose hash a file keeps, and in words if it has just been made.

    Args:
        path: the file of the hash.
        is_new: whether to make a new token even if there is one.

    Raises:
        StorageError: the file cannot be read or written.
    """
    with storing(f"{path} cannot be used"):
        if not is_new and path.exists():
            with suppress(ValueError, KeyError, TypeError):
                return AccessToken(bytes.fromhex(json.loads(path.read_text(encoding="ascii"))["sha256"])), None
        token = secrets.token_urlsafe(_BYTES)
        write_at_once(path, json.dumps({"sha256": _digest(token).hex()}).encode())
    return AccessToken(_digest(token)), token


def _digest(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).digest()
