"""For a JupyterHub of the tests: system users that no /etc/passwd knows.

The hub runs as root and starts each server with JupyterHub's own LocalProcessSpawner, which asks `pwd` for its user. That is
answered from the file that HUB_USERS names, in the form of /etc/passwd.
"""

from __future__ import annotations

import os
import pwd
from pathlib import Path

from jupyterhub.spawner import LocalProcessSpawner

_known = pwd.getpwnam
_users = {}
for _line in Path(os.environ["HUB_USERS"]).read_text().splitlines():
    _name, _password, _uid, _gid, *_rest = _line.split(":")
    _users[_name] = pwd.struct_passwd((_name, _password, int(_uid), int(_gid), *_rest))
pwd.getpwnam = lambda name: _users.get(name) or _known(name)


class Spawner(LocalProcessSpawner):
    """The usual one, with these users."""
