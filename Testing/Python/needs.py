"""What a test says when a Debian package that it needs is not installed.

Such a test skips and names the package. With DSPACE_REQUIRE_ALL=1 (continuous integration) it fails instead, so that
a package which `./dspace` forgets to install cannot hide tests. Real data that is absent is no missing package: tests
that need it call pytest.skip().
"""
import importlib
import os
import shutil

import pytest


def lacks(package):
    """Ends the test, or the module that is being imported."""
    reason = f"{package} is not installed"
    if os.environ.get("DSPACE_REQUIRE_ALL") == "1":
        pytest.fail(f"{reason}, and DSPACE_REQUIRE_ALL=1 accepts no skip for a missing package", pytrace=False)
    pytest.skip(reason, allow_module_level=True)


def needs_module(name, package):
    """The Python module `name`, which the Debian package brings."""
    try:
        return importlib.import_module(name)
    except ImportError:
        lacks(package)


def needs_program(name, package):
    """The path of the program `name`, which the Debian package brings."""
    path = shutil.which(name, path="/usr/bin")  # no other version of it
    return path or lacks(package)
