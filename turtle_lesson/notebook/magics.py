"""`%ros2`, `%colcon`, `%source` and the same words typed bare, as in a terminal, for IPython and Jupyter."""

from __future__ import annotations

from typing import Any

from IPython.core.magic import Magics, line_cell_magic, line_magic, magics_class, no_var_expand

from ..ros.cli import cells, completion
from ..ros.cli.shell import Shell, begin_here, run_line
from ..ros.runtime.world import current_world

EXIT_CODE = "_exit_code"


@magics_class
class TerminalMagics(Magics):
    """The terminal of a notebook. Nothing in its lines is expanded: `{…}` and `$…` are YAML, and not Python."""

    @no_var_expand
    @line_cell_magic
    def terminal(self, line: str, cell: str | None = None) -> None:
        """Run commands as in a terminal: `%terminal ros2 topic list && ros2 node list`, or a whole cell of them."""
        self._run(line if cell is None else f"{line}\n{cell}")

    @no_var_expand
    @line_magic
    def ros2(self, line: str) -> None:
        """The command line of ROS 2. `%ros2 -h` lists its commands."""
        self._run(f"ros2 {line}")

    @no_var_expand
    @line_magic
    def colcon(self, line: str) -> None:
        """Build the workspace: `%colcon build`."""
        self._run(f"colcon {line}")

    @no_var_expand
    @line_magic
    def source(self, line: str) -> None:
        """Make what was built findable: `%source install/setup.bash`."""
        self._run(f"source {line}")

    def _run(self, script: str) -> None:
        assert self.shell is not None
        try:
            run_line(current_world(), script)
        finally:
            self.shell.user_ns[EXIT_CODE] = Shell(current_world()).exit_code


def install(shell: Any) -> None:
    """Make an IPython shell understand commands; doing it twice changes nothing."""
    begin_here()
    shell.register_magics(TerminalMagics)
    transformers = shell.input_transformer_manager.line_transforms  # before IPython takes the cell for Python
    transformers[:] = [each for each in transformers if not getattr(each, "is_turtle_lesson", False)]

    def transform(lines: list[str]) -> list[str]:
        return cells.translate(lines, shell.user_ns)

    transform.is_turtle_lesson = True  # type: ignore[attr-defined]
    transformers.append(transform)
    completion.install(shell)
