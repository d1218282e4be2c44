"""Who may talk to a server on this computer."""

import secrets
from collections.abc import Sequence
from http import HTTPStatus
from urllib.parse import parse_qs, urlsplit

__all__ = ["HOST", "check_port", "path_and_token", "refusal"]

HOST = "127.0.0.1"  # loopback, and nothing else: a face is nobody else's business


def check_port(port: int) -> None:
    """Refuse what is no port.

    Raises
    ------
    ValueError
        If it is not in 0..65535.

    Examples
    --------
    >>> check_port(99999)
    Traceback (most recent call last):
        ...
    ValueError: port: expected 0 (a free one) to 65535, got 99999
    """
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port < 2**16:
        raise ValueError(f"port: expected 0 (a free one) to 65535, got {port!r}")


def path_and_token(target: str) -> tuple[str, str]:
    """Path and token of a request target; nothing where it is none, which then is served nowhere.

    Examples
    --------
    >>> path_and_token("/page?token=abc"), path_and_token("http://[")
    (('/page', 'abc'), ('', ''))
    """
    try:
        found = urlsplit(target)
        return found.path, parse_qs(found.query).get("token", [""])[0]
    except ValueError:  # brackets that hold no address
        return "", ""


def refusal(
    hosts: Sequence[str], origins: Sequence[str], given: str, *, port: int, token: str
) -> tuple[HTTPStatus, str] | None:
    """Why a request is not served, as status and text; None if it is.

    Parameters
    ----------
    hosts, origins
        All values of the headers ``Host`` and ``Origin``. Browsers say where a page comes from, and no other page may
        talk to us; programs say nothing.
    given : str
        The token that came with the request.
    port : int
        Of the server.
    token : str
        That of the server.

    Examples
    --------
    >>> refusal(["127.0.0.1:80"], [], "abc", port=80, token="abc") is None
    True
    >>> refusal(["127.0.0.1:80"], ["https://example.org"], "abc", port=80, token="abc")
    (<HTTPStatus.FORBIDDEN: 403>, 'pages from elsewhere are not served\\n')
    """
    own = {f"{name}:{port}" for name in (HOST, "localhost")}
    if len(hosts) != 1 or hosts[0] not in own:  # a name that an attacker made point at this computer
        return HTTPStatus.FORBIDDEN, "this host is not served\n"
    if not {f"http://{host}" for host in own}.issuperset(origins):
        return HTTPStatus.FORBIDDEN, "pages from elsewhere are not served\n"
    if not secrets.compare_digest(given.encode(), token.encode()):
        return HTTPStatus.UNAUTHORIZED, "the token is missing or wrong\n"
    return None
