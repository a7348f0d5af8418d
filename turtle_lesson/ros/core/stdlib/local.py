"""`threading.local` in a simulated process: each of its threads sees attributes of its own.

It is the class that Python keeps for systems whose threads have none in C: it goes by `threading.current_thread`.
"""

from __future__ import annotations

import importlib
import threading
from typing import Any

RealLocal: Any = threading.local
module: Any = importlib.import_module("_threading_local")
VirtualLocal: Any = module.local
