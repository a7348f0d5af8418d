"""The texts of the files that `ros2 pkg create` writes, as ROS 2 Humble has them where they are code, in our words else."""

from __future__ import annotations

from collections.abc import Sequence
from xml.sax.saxutils import escape, quoteattr

MODEL = "http://download.ros.org/schema/package_format{format}.xsd"
LINTERS = ("ament_lint_auto", "ament_lint_common")
PYTHON_LINTERS = ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest")


def package_xml(
    name: str,
    *,
    build_type: str,
    description: str,
    maintainer: tuple[str, str],
    licence: str,
    dependencies: Sequence[str] = (),
    package_format: str = "3",
) -> str:
    """A `package.xml`; the maintainer is a name and an e-mail address."""
    who, email = maintainer
    tool = {"ament_cmake": "ament_cmake", "cmake": "cmake"}.get(build_type)
    tests = {"ament_cmake": LINTERS, "ament_python": PYTHON_LINTERS}.get(build_type, ())
    blocks = [
        [f"<name>{escape(name)}</name>", "<version>0.0.0</version>", f"<description>{escape(description)}</description>",
         f"<maintainer email={quoteattr(email)}>{escape(who)}</maintainer>", f"<license>{escape(licence)}</license>"],
        [f"<buildtool_depend>{tool}</buildtool_depend>"] if tool else [],
        [f"<depend>{escape(each)}</depend>" for each in dependencies],
        [f"<test_depend>{each}</test_depend>" for each in tests],
        ["<export>", f"  <build_type>{build_type}</build_type>", "</export>"],
    ]  # fmt: skip
    body = "\n\n".join("\n".join(f"  {line}" for line in block) for block in blocks if block)
    schema = f'href="{MODEL.format(format=package_format)}" schematypens="http://www.w3.org/2001/XMLSchema"'
    head = f'<?xml version="1.0"?>\n<?xml-model {schema}?>\n<package format="{package_format}">\n'
    return f"{head}{body}\n</package>\n"


def cmake_lists(
    name: str, *, build_type: str, dependencies: Sequence[str], node: str | None = None, library: str | None = None
) -> str:
    """A `CMakeLists.txt`, for a C++ program `node` and a library where they are asked for."""
    ament = build_type == "ament_cmake"
    parts = [_CMAKE_HEAD.format(name=name, warnings=_WARNINGS), "# what this package needs\n"]
    if ament:
        parts.append("find_package(ament_cmake REQUIRED)\n")
    parts += [f"find_package({each} REQUIRED)\n" for each in dependencies]
    if not dependencies:
        parts.append("# write one line for each further package: find_package(<dependency> REQUIRED)\n")
    if library:
        parts.append(_LIBRARY.format(library=library) + _linked(library, dependencies, ament))
    if node:
        parts.append(_NODE.format(node=node) + _linked(node, dependencies, ament))
        parts.append(_INSTALL_NODE.format(node=node))
    if ament:
        parts.append(_LINT + "\nament_package()\n")
    return "".join(parts)


def _linked(target: str, dependencies: Sequence[str], ament: bool) -> str:
    if not dependencies or not ament:
        return ""
    names = "".join(f"\n  {each}" for each in dependencies)
    return f"ament_target_dependencies(\n  {target}{names}\n)\n"


_WARNINGS = """\
if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()
"""
_CMAKE_HEAD = """\
cmake_minimum_required(VERSION 3.8)
project({name})

{warnings}
"""
_LIBRARY = """
add_library({library} src/{library}.cpp)
target_include_directories({library} PUBLIC
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:include>)
"""
_NODE = """
add_executable({node} src/{node}.cpp)
target_include_directories({node} PUBLIC
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:include>)
target_compile_features({node} PUBLIC c_std_99 cxx_std_17)
"""
_INSTALL_NODE = """
install(TARGETS {node}
  DESTINATION lib/${{PROJECT_NAME}})
"""
_LINT = """
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  # These two checks are left out until the files have copyright lines and lie in a git repository.
  set(ament_cmake_copyright_FOUND TRUE)
  set(ament_cmake_cpplint_FOUND TRUE)
  ament_lint_auto_find_test_dependencies()
endif()
"""


def setup_py(name: str, *, description: str, maintainer: tuple[str, str], licence: str, node: str | None) -> str:
    """The `setup.py` of an `ament_python` package."""
    scripts = f"            '{node} = {name}.{node}:main'\n" if node else ""
    return _SETUP_PY.format(
        name=name, who=maintainer[0], email=maintainer[1], description=description, licence=licence, scripts=scripts
    )


_SETUP_PY = """\
from setuptools import find_packages, setup

package_name = '{name}'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={who!r},
    maintainer_email={email!r},
    description={description!r},
    license={licence!r},
    tests_require=['pytest'],
    entry_points={{
        'console_scripts': [
{scripts}        ],
    }},
)
"""


def setup_cfg(name: str) -> str:
    """The `setup.cfg` that has programs installed where ROS 2 looks for them."""
    place = f"$base/lib/{name}"
    return f"[develop]\nscript_dir={place}\n[install]\ninstall_scripts={place}\n"


def python_node(name: str, node: str) -> str:
    """The first program of an `ament_python` package."""
    return f"def main():\n    print('Hi from {name}.')\n\n\nif __name__ == '__main__':\n    main()\n"


def cpp_node(name: str) -> str:
    """The first program of an `ament_cmake` package."""
    return f"""\
#include <cstdio>

int main(int argc, char ** argv)
{{
  (void) argc;
  (void) argv;

  printf("hello world {name} package\\n");
  return 0;
}}
"""


def cpp_library(name: str, library: str) -> tuple[str, str]:
    """Header and source of a C++ library with one empty class."""
    class_name = "".join(part.capitalize() for part in library.split("_"))
    guard = f"{name}__{library}_HPP_".upper()
    header = (
        f"#ifndef {guard}\n#define {guard}\n\nnamespace {name}\n{{\n\nclass {class_name}\n{{\npublic:\n"
        f"  {class_name}();\n  virtual ~{class_name}();\n}};\n\n}}  // namespace {name}\n\n#endif  // {guard}\n"
    )
    source = (
        f'#include "{name}/{library}.hpp"\n\nnamespace {name}\n{{\n\n{class_name}::{class_name}()\n{{\n}}\n\n'
        f"{class_name}::~{class_name}()\n{{\n}}\n\n}}  // namespace {name}\n"
    )
    return header, source


def style_test(tool: str) -> str:
    """`test/test_flake8.py` and its kin: one check of the code's style."""
    call = {"flake8": "main_with_errors(argv=[])[0]", "pep257": "main(argv=['.', 'test'])"}.get(
        tool, "main(argv=['.', 'test'])"
    )
    function = call.partition("(")[0]
    skip = "@pytest.mark.skip(reason='The files have no copyright lines yet')\n" if tool == "copyright" else ""
    mark = f"{skip}@pytest.mark.linter\n@pytest.mark.{tool}\n"
    return (
        f"from ament_{tool}.main import {function}\nimport pytest\n\n\n{mark}def test_{tool}():\n"
        f"    assert {call} == 0, 'ament_{tool} found fault with the code'\n"
    )


def licence_text(identifier: str, holder: str) -> str:
    """What goes into LICENSE: which licence it is, and where its words are."""
    return (
        f"{identifier}\n\nCopyright {holder}\n\nThis package is licensed under {identifier}. Its full text is at\n"
        f"https://spdx.org/licenses/{identifier}.html; put it here in place of these lines before you publish.\n"
    )
