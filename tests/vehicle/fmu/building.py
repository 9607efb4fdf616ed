"""The FMU of a linear single-track car, built from its source with the system's compiler."""

import platform
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Final, Literal

SOURCE: Final = Path(__file__).with_name("single_track.c")
NAMES: Final = ("delta", "throttle", "brake", "v", "vy", "r", "v0", "vg")
OUTPUTS: Final = ("v", "vy", "r", "vg")
PROFILE: Final = """\
platform: own
kind: fmu
file: car{version}.fmu
parameters: {{v0: {speed_mps}}}
names: {{road_wheel_rad: delta, throttle: throttle, brake: brake, vx_mps: v, vy_mps: vy, yaw_rate_radps: r}}
rear_overhang_m: 0.8
"""


def _described(version: Literal[2, 3]) -> str:
    rows = []
    for number, name in enumerate(NAMES):
        causality = "output" if name in OUTPUTS else "parameter" if name == "v0" else "input"
        variability = "fixed" if name == "v0" else "continuous"
        begin = "" if name in OUTPUTS else ' start="0.0"'
        about = f'name="{name}" valueReference="{number}" causality="{causality}" variability="{variability}"'
        if version == 2:
            rows.append(f"<ScalarVariable {about}><Real{begin}/></ScalarVariable>")
        else:
            rows.append(f"<Float64 {about}{begin}/>")
    places = [number + 1 for number, name in enumerate(NAMES) if name in OUTPUTS]
    unknown = "".join(f'<Unknown index="{at}"/>' for at in places)
    if version == 3:
        unknown = "".join(f'<Output valueReference="{at - 1}"/>' for at in places)
    listed = f"<Outputs>{unknown}</Outputs>" if version == 2 else unknown
    token = 'guid="{car}"' if version == 2 else 'instantiationToken="{car}"'
    if version == 3:
        rows.append('<Float64 name="time" valueReference="99" causality="independent" variability="continuous"/>')
    kind = '<CoSimulation modelIdentifier="car" canHandleVariableCommunicationStepSize="true"/>'
    parts = f"{kind}<ModelVariables>{''.join(rows)}</ModelVariables><ModelStructure>{listed}</ModelStructure>"
    head = f'fmiModelDescription fmiVersion="{version}.0" modelName="car" {token}'
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<{head}>{parts}</fmiModelDescription>'


def build(folder: Path, version: Literal[2, 3], speed_mps: float = 20.0) -> Path:
    """Build the unit and a profile that names it; return the profile."""
    library = folder / f"car{version}.so"
    defined = ["-DFMI3"] if version == 3 else []
    subprocess.run(["gcc", "-O2", "-shared", "-fPIC", *defined, SOURCE, "-o", library], check=True)
    where = "linux64" if version == 2 else f"{platform.machine()}-{sys.platform}"
    with zipfile.ZipFile(folder / f"car{version}.fmu", "w") as unit:
        unit.writestr("modelDescription.xml", _described(version))
        unit.write(library, f"binaries/{where}/car.so")
    profile = folder / f"car{version}.yaml"
    profile.write_text(PROFILE.format(version=version, speed_mps=speed_mps))
    return profile
