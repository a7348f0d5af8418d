"""Substitutions that find packages and what is in them."""

from launch._missing import explain_missing

from .executable_in_package import ExecutableInPackage
from .find_package import FindPackage, FindPackagePrefix, FindPackageShare
from .parameter import Parameter

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]

__getattr__ = explain_missing(__name__, {"FindPackageShareDirectory": "use FindPackageShare"})
