"""What a wheel takes along from outside of python/: the FMUs that are built, a table of inputs, named parameters."""

from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Files(BuildHookInterface):
    """Adds files to the wheel."""

    def initialize(self, version, build_data):
        """Name the files; without the first FMU there is nothing to pack."""
        root = Path(self.root)
        built = sorted((root / "target").glob("WheelRailContact*.fmu"))
        if root / "target" / "WheelRailContact.fmu" not in built:
            raise FileNotFoundError("target/WheelRailContact.fmu is not there: run `make fmu` first")
        build_data["force_include"] |= {str(path): f"wheelrail/fmu/{path.name}" for path in built}
        build_data["force_include"][str(root / "examples" / "braking.csv")] = "wheelrail/data/braking.csv"
        for path in sorted((root / "presets").glob("*.toml")):
            build_data["force_include"][str(path)] = f"wheelrail/presets/{path.name}"
