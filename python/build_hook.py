"""What a wheel takes along from outside of python/: FMUs, the command line, a table of inputs, named parameters.

The command line is a program for the platform that it was built on, and so is a wheel with it.
`WHEELRAIL_WHEEL=win_amd64` takes that which `make platforms` has built for Windows, `WHEELRAIL_WHEEL=any` makes a wheel
without one, for each platform that the FMUs have a library for.
"""

import os
import sysconfig
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Files(BuildHookInterface):
    """Adds files to the wheel."""

    def initialize(self, version, build_data):
        """Name the files; without the first FMU, or the command line, there is nothing to pack."""
        target = Path(self.root) / "target"
        fmus = sorted({needed(target / "WheelRailContact.fmu"), *target.glob("WheelRailContact*.fmu")})
        build_data["force_include"] |= {str(path): f"wheelrail/fmu/{path.name}" for path in fmus}
        build_data["force_include"][f"{self.root}/examples/braking.csv"] = "wheelrail/data/braking.csv"
        for path in sorted(Path(self.root, "presets").glob("*.toml")):
            build_data["force_include"][str(path)] = f"wheelrail/presets/{path.name}"
        # What is linked in, as CycloneDX, where PEP 770 has it.
        build_data["sbom_files"].append("modelDescription/licenses/THIRD-PARTY.cdx.json")
        wanted = os.environ.get("WHEELRAIL_WHEEL")
        if wanted == "any":
            return
        build_data["sbom_files"].append("python/licenses/COMMAND.cdx.json")
        if wanted == "win_amd64":
            command = needed(target / "platforms" / "win64" / "wheelrail.exe", "make platforms")
        else:
            command = needed(target / "release" / ("wheelrail.exe" if os.name == "nt" else "wheelrail"))
        build_data["shared_scripts"][str(command)] = command.name
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{wanted or platform(target)}"


def needed(path, made_by="make fmu"):
    """A file that a target of the Makefile builds."""
    if not path.exists():
        raise FileNotFoundError(f"{path.name} is not in {path.parent}: run `{made_by}` first")
    return path


def platform(target):
    """The tag of the platform: tools/cargo.py says whether the command was linked against glibc 2.17, that of 2014."""
    portable = target / "library.portable"
    if portable.exists() and portable.read_text().strip() == "True":
        return "manylinux2014_x86_64"
    return sysconfig.get_platform().replace("-", "_").replace(".", "_")
