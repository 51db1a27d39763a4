"""Builds the extension module by CMake:   pip install --no-build-isolation ."""

import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent


class BuildByCMake(build_ext):
    def build_extension(self, ext: Extension) -> None:
        target = Path(self.get_ext_fullpath(ext.name)).resolve()
        build = Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cmake", "-S", str(HERE), "-B", str(build), "-DCMAKE_BUILD_TYPE=Release",
                        f"-DPython_EXECUTABLE={sys.executable}", f"-DCNCPLAN_PYTHON_PACKAGE={build / 'package'}",
                        *os.environ.get("CMAKE_ARGS", "").split()], check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "cncplan_python"], check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        made, = (build / "package" / "cncplan").glob("_core.*.so")
        self.copy_file(str(made), str(target))


def version() -> str:
    text = (HERE.parent / "include/cncplan/version.hpp").read_text()
    return ".".join(re.search(rf"VERSION_{part} (\d+)", text)[1] for part in ("MAJOR", "MINOR", "PATCH"))


setup(version=version(), ext_modules=[Extension("cncplan._core", sources=[])], cmdclass={"build_ext": BuildByCMake})
