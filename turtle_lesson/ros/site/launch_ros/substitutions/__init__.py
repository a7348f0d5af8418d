"""Substitutions that find packages and what is in them."""

from launch._missing import explain_missing

from .executable_in_package import ExecutableInPackage
from .find_package import FindPackage, FindPackagePrefix, FindPackageShare

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare"]

__getattr__ = explain_missing(__name__, {"Parameter": "", "FindPackageShareDirectory": "use FindPackageShare"})
