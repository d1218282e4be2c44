"""The package ``websockets``, if it is installed."""

from types import ModuleType, SimpleNamespace

from toongeo._extras import missing_extra

__all__ = ["load_websockets"]


def load_websockets() -> SimpleNamespace:
    """``serve``, ``broadcast``, ``connect`` and the errors ``ConnectionClosed``, ``InvalidStatus`` and so on.

    Raises
    ------
    ImportError
        If it is not installed; says which extra has it.
    """
    server, client, errors = _modules()
    return SimpleNamespace(
        serve=server.serve,
        broadcast=server.broadcast,
        connect=client.connect,
        ConnectionClosed=errors.ConnectionClosed,
        InvalidHandshake=errors.InvalidHandshake,
        InvalidStatus=errors.InvalidStatus,
        InvalidURI=errors.InvalidURI,
    )


def _modules() -> tuple[ModuleType, ModuleType, ModuleType]:
    try:
        import websockets.asyncio.server
        import websockets.exceptions
        import websockets.sync.client
    except ImportError as error:
        raise ImportError(missing_extra("live driving", "serve")) from error
    return websockets.asyncio.server, websockets.sync.client, websockets.exceptions
