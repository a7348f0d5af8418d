"""What the tests that run cells in a real kernel share."""

from __future__ import annotations

from jupyter_client.blocking.client import BlockingKernelClient
from jupyter_client.manager import KernelManager
from jupyter_core.utils import ensure_event_loop


def end(manager: KernelManager, client: BlockingKernelClient) -> None:
    """End a kernel, and close the event loop that jupyter_client leaves open."""
    client.stop_channels()
    manager.shutdown_kernel(now=True)
    ensure_event_loop().close()
