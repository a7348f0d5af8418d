"""The console command `turtle-lesson`."""

from __future__ import annotations

import argparse
import json
import os
import runpy
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from ..ros.runtime.files import OPENED
from ..ros.sim.errors import print_error
from . import pages
from .copies import MEMORY, PATIENCE, TIMEOUT, find
from .grade import as_csv, as_json, as_junit, grade, in_words

JUPYTER = Path(__file__).resolve().parent / "jupyter"
"""Holds the kernel that says which cell to run after a restart, and settings: no news, and no look for updates."""

FIRST = "00_welcome.ipynb"

GRADE = """\
Run copies of pages, each in a kernel and a folder of its own, and print the points for each check.

Checks are carried out and judged by the installed lesson's code: what a copy shows, writes or edits earns nothing, and a copy
that has replaced code of the lesson is named, and earns nothing from then on. Cells and checks share one process, though, and
your rights: a copy that fakes what the checks observe cannot be stopped, nor can one that attacks the grader itself. Grade what
you do not trust in a container (the folder must hold the copies; the image, an installed lesson):

  docker run --rm --network none --memory 4g --pids-limit 500 --user 1000 -v "$PWD/copies:/copies:ro" \\
    IMAGE turtle-lesson grade --json /copies > points.json"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Carry out a command line; returns the exit code: 0, 1 where something could not be done, 2 for a wrong use.

    Without a command it opens the lesson.
    """
    parser = _parser()
    options, more = parser.parse_known_args((sys.argv[1:] if arguments is None else arguments) or ["open"])
    if more and options.act is not _open:
        parser.error(f"unrecognized arguments: {' '.join(more)}")
    options.more = more
    try:
        return options.act(options)
    except (pages.PageError, OSError) as error:
        said = f"{error.filename}: {error.strerror}" if isinstance(error, OSError) and error.filename else error
        print(f"turtle-lesson {options.command}: {said}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="turtle-lesson",
        description="Open the lesson's pages in JupyterLab (the default), reset them, grade copies, run experiments.",
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    text = "Open your own folder of the lesson's pages in JupyterLab. It is made if it does not exist; your work in it stays."
    text += " Other options, such as --no-browser, are passed on to JupyterLab."
    opening = commands.add_parser("open", help="your folder of pages, in JupyterLab", description=text)
    opening.set_defaults(act=_open)
    where = f"your folder (default: this one if it is yours already, or else {pages.FOLDER} in it)"
    opening.add_argument("folder", nargs="?", type=Path, metavar="DIR", help=where)
    port = _number(int, 0, 65535)
    opening.add_argument("--port", type=port, metavar="N", help="default: 8888 or the next free one")
    begun = "copy the pages that you began in the checkout's notebooks"
    opening.add_argument("--take-along", action="store_true", help=begun)
    hub = "be a learner's server of JupyterHub, which calls this command (deploy/jupyterhub shows how)"
    opening.add_argument("--hub", action="store_true", help=hub)

    grading = commands.add_parser("grade", help="points for each check", description=GRADE)
    grading.formatter_class = argparse.RawDescriptionHelpFormatter
    grading.set_defaults(act=_grade)
    grading.add_argument(
        "paths", nargs="+", type=Path, metavar="PATH", help="a notebook, or a folder or zip file of notebooks"
    )
    grading.add_argument("--json", action="store_true", help="print JSON, with every row of every check")
    grading.add_argument("--junit", type=Path, metavar="FILE", help="also write a JUnit report")
    grading.add_argument("--csv", type=Path, metavar="FILE", help="also write a table with a line for each copy")
    how_long = f"computing time that one copy may take, s (default: {TIMEOUT:g}); waiting, {PATIENCE} times as long"
    seconds = _number(float, 1, 86400)
    grading.add_argument("--timeout", type=seconds, default=TIMEOUT, metavar="SECONDS", help=how_long)
    how_much = f"memory that each process of a copy may take, where the system limits that (default: {MEMORY:g})"
    grading.add_argument("--memory", type=_number(float, 0.5, 1000), default=MEMORY, metavar="GB", help=how_much)
    place = grading.add_mutually_exclusive_group()
    many = "how many at once (default: one for each core that may be used)"
    place.add_argument("--jobs", type=_number(int, 1, 256), metavar="N", help=many)
    cluster = "run them on a Dask cluster instead; the address of its scheduler, such as tcp://10.0.0.1:8786"
    place.add_argument("--client", metavar="ADDRESS", help=cluster)

    text = "Run a Python script that calls turtle_lesson.experiments.experiment(), and print its tables. The exit code is 1 if"
    text += " a run has failed."
    running = commands.add_parser("run", help="an experiment of many runs", description=text)
    running.set_defaults(act=_run)
    running.add_argument("script", type=Path, metavar="EXPERIMENT.py", help="the script")
    running.add_argument("--jobs", type=_number(int, 1, 512), metavar="N", help=many)
    where = "also save the table, to NAME.csv or NAME.parquet (further ones of the script: NAME-2.csv, …)"
    running.add_argument("--csv", type=Path, metavar="FILE", help=where)

    text = "Restore the published state of a page, in your folder without outputs."
    text += " Your version is kept beside it, as NAME.mine-1.ipynb."
    reset = commands.add_parser("reset", help="a page as it was published", description=text)
    reset.set_defaults(act=_reset)
    reset.add_argument("notebook", type=Path, metavar="NOTEBOOK")

    text = "Write a page without its solutions and outputs."
    student = commands.add_parser("student", help="a page without solutions and outputs", description=text)
    student.set_defaults(act=_student)
    student.add_argument("notebook", type=Path, metavar="NOTEBOOK")
    where = "file or folder to write to (default: NAME.student.ipynb beside it)"
    student.add_argument("--to", type=Path, metavar="PATH", help=where)

    return parser


def _number(kind: type[int] | type[float], least: float, most: float) -> Callable[[str], float]:
    """What reads an option's number, within limits."""

    def number(text: str) -> float:
        if not least <= kind(text) <= most:
            raise argparse.ArgumentTypeError(f"must be from {least} to {most}")
        return kind(text)

    return number


def _grade(options: argparse.Namespace) -> int:
    copies = find(options.paths)
    if not copies:
        raise pages.PageError(f"there is no notebook in {', '.join(map(str, options.paths))}")
    from ..experiments.pools import cores

    os.environ["TURTLE_LESSON_CACHE"] = "off"  # a copy runs with the teacher's rights, and could have written into it
    graded = grade(copies, options.timeout, options.memory, options.jobs or cores(), options.client)
    print(json.dumps(as_json(graded), indent=1, ensure_ascii=False) if options.json else in_words(graded))
    for file, text in ((options.junit, as_junit), (options.csv, as_csv)):
        if file is not None:
            file.write_text(text(graded), encoding="utf-8")
    return 1 if any(copy.problem for copy in graded) else 0


def _open(options: argparse.Namespace) -> int:
    if options.hub:
        os.umask(0o077)  # from the folder on, nothing that is made here is for other users of the computer
    path = options.folder or Path("." if pages.is_learners(Path(".")) else pages.FOLDER)
    new = not pages.is_learners(path)
    folder = pages.LearnersFolder(path)
    said = folder.update()
    if options.take_along:
        said += folder.take_along()
    elif new and (begun := pages.begun()):
        said.append(f"You began {', '.join(begun)} in {pages.PUBLISHED}. Add --take-along to bring your work here.")
    said.append(f"Your pages are in {folder.path.resolve()}.")
    if options.hub:
        print("\n".join(said))
        return serve(folder.path, "jupyterhub.singleuser", options.more)
    print("\n".join(said), "Ctrl-C, pressed twice here, ends JupyterLab.")
    words = ["--Application.log_level=ERROR", *options.more]
    words += ["--ServerApp.ip=127.0.0.1", f"--LabApp.default_url=/lab/tree/{FIRST}"]
    if options.port is not None:
        words += [f"--ServerApp.port={options.port}", "--ServerApp.port_retries=0"]
    return serve(folder.path, "jupyterlab", words)


def serve(folder: Path, server: str, options: Sequence[str]) -> int:
    """Run a Jupyter server, a module, until it is stopped; where the system can, in place of this process."""
    words = [sys.executable, "-P", "-m", server, *options, f"--ServerApp.root_dir={folder.resolve()}"]
    environment = dict(os.environ) | {OPENED: str(folder.resolve()), "JUPYTERHUB_DEFAULT_URL": f"/lab/tree/{FIRST}"}
    for name in ("JUPYTER_PATH", "JUPYTER_CONFIG_PATH"):
        environment[name] = os.pathsep.join([str(JUPYTER), *filter(None, [os.environ.get(name)])])
    sys.stdout.flush()
    if os.name == "posix":
        os.execve(sys.executable, words, environment)
    return subprocess.call(words, env=environment)


def _reset(options: argparse.Namespace) -> int:
    kept = pages.reset(options.notebook)
    yours = f"Yours is kept as {kept.name}." if kept else "It already was."
    print(f"{options.notebook} is as it was published. {yours}")
    return 0


def _run(options: argparse.Namespace) -> int:
    """Run a script that calls `experiment(…)`. 0 if all runs of its experiments ended well, or else 1."""
    from ..experiments import ExperimentError, Results
    from ..experiments.experiment import Defaults, defaults
    from ..experiments.table import check_suffix

    script, table, seen = options.script, options.csv, list[Results]()

    def finished(results: Results) -> None:
        seen.append(results)
        print(results, flush=True)
        if table is not None:
            path = table if len(seen) == 1 else table.with_stem(f"{table.stem}-{len(seen)}")
            print(f"saved as {results.save(path)}", flush=True)

    if not script.is_file():
        raise pages.PageError(f"there is no script {script}")
    token = defaults.set(Defaults(options.jobs, finished))
    arguments, folders = sys.argv, sys.path[:]
    ended_well = False
    try:
        if table is not None:
            check_suffix(table)
        sys.argv, sys.path[0:1] = [str(script)], [str(script.resolve().parent)]
        runpy.run_path(str(script), run_name="__main__")
        ended_well = True
    except ExperimentError as error:
        print(f"turtle-lesson run: {error}", file=sys.stderr)
    except SystemExit as error:
        ended_well = error.code in (None, 0)
        if isinstance(error.code, str):
            print(error.code, file=sys.stderr)
    except Exception as error:
        print_error(error)
    finally:
        sys.argv, sys.path[:] = arguments, folders
        defaults.reset(token)
    if ended_well and not seen:
        print(f"turtle-lesson run: {script} carries out no experiment", file=sys.stderr)
    return 0 if ended_well and seen and not any(results.missing or len(results.failed) for results in seen) else 1


def _student(options: argparse.Namespace) -> int:
    written, removed = pages.without_solutions(options.notebook, options.to)
    cells = "1 cell with a solution was" if removed == 1 else f"{removed} cells with solutions were"
    print(f"{written}: {cells} left out.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
