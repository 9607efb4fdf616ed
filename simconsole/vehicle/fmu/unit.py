"""One instance of an FMU for co-simulation, 2.0 or 3.0: set, step, get, and begin again."""

import hashlib
import math
import shutil
import weakref
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from simconsole.values.errors import ProfileError, VehicleError, one_line


class Unit:
    """A unit at work. Its numbers are 64-bit floats: Real in 2.0, Float64 in 3.0."""

    def __init__(self, path: str, sha256: str, inputs: Sequence[str], outputs: Sequence[str]) -> None:
        """Open a file.

        Raises:
            ProfileError: it is not the one that was read, no unit for co-simulation, or has no such variables.
        """
        try:
            import fmpy
        except ImportError:
            raise ProfileError("vehicle: kind: value fmu: needs the extra fmu: pip install simconsole[fmu]") from None
        try:
            content = Path(path).read_bytes()
        except OSError as error:
            raise ProfileError(f"{path}: {error.strerror}") from None
        if hashlib.sha256(content).hexdigest() != sha256:
            raise ProfileError(f"{path}: another file than when the drive was recorded")
        try:
            self._description: Any = fmpy.read_model_description(path)
            self._folder = fmpy.extract(path)
        except Exception as error:  # whatever fmpy makes of a stranger's file
            raise ProfileError(f"{path}: no FMU: {error}".replace("\n", " ")) from error
        weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
        self._path = path
        if self._description.coSimulation is None:
            raise ProfileError(f"{path}: an FMU for co-simulation")
        self._known = {one.name: one.valueReference for one in self._description.modelVariables}
        self._names = tuple(outputs)
        self._inputs, self._outputs = self._references(inputs), self._references(outputs)
        self._is_3 = str(self._description.fmiVersion).startswith("3")
        try:
            self._unit: Any = self._opened()
            self._unit.instantiate()
        except Exception as error:  # a library for another machine, or without what the standard asks for
            raise ProfileError(f"{path}: cannot be opened: {error}".replace("\n", " ")) from error
        weakref.finalize(self, self._unit.freeInstance)

    def begin(self, start: Mapping[str, float]) -> list[float]:
        """Begin anew with these values of variables, and return the outputs.

        Raises:
            ProfileError: there is no such variable.
            VehicleError: the unit fails, or has no finite number for an output.
        """
        references = self._references(list(start))
        with self._at_work(0.0):
            self._unit.reset()
            if start:
                self._set(references, list(start.values()))
            if not self._is_3:
                self._unit.setupExperiment(startTime=0.0)
                self._unit.enterInitializationMode()
            else:
                self._unit.enterInitializationMode(startTime=0.0)
            self._unit.exitInitializationMode()
            return self._get(0.0)

    def step(self, time_s: float, step_s: float, inputs: Sequence[float]) -> list[float]:
        """Step from `time_s` on with these inputs, and return the outputs.

        Raises:
            VehicleError: the unit fails, or has no finite number for an output.
        """
        with self._at_work(time_s):
            self._set(self._inputs, list(inputs))
            self._unit.doStep(currentCommunicationPoint=time_s, communicationStepSize=step_s)
            return self._get(time_s + step_s)

    @contextmanager
    def _at_work(self, time_s: float) -> Iterator[None]:
        try:
            yield
        except VehicleError:
            raise
        except Exception as error:  # whatever fmpy makes of what the unit says
            raise self._failed(time_s, one_line(error)) from error

    def _failed(self, time_s: float, why: str) -> VehicleError:
        return VehicleError(f"{self._path}: at {1000.0 * time_s:.0f} ms: {why}")

    def _references(self, names: Sequence[str]) -> list[int]:
        missing = [name for name in names if name not in self._known]
        if missing:
            raise ProfileError(f"{self._path}: no variable {missing[0]}: one of {', '.join(sorted(self._known))}")
        return [self._known[name] for name in names]

    def _opened(self) -> Any:
        about = {
            "guid": self._description.guid,
            "unzipDirectory": self._folder,
            "modelIdentifier": self._description.coSimulation.modelIdentifier,
            "instanceName": "vehicle",
        }
        if self._is_3:
            from fmpy.fmi3 import FMU3Slave

            return FMU3Slave(**about)
        from fmpy.fmi2 import FMU2Slave

        return FMU2Slave(**about)

    def _set(self, references: list[int], values: list[float]) -> None:
        (self._unit.setFloat64 if self._is_3 else self._unit.setReal)(references, values)

    def _get(self, time_s: float) -> list[float]:
        found = (self._unit.getFloat64 if self._is_3 else self._unit.getReal)(self._outputs)
        values = [float(value) for value in found]
        for name, value in zip(self._names, values, strict=True):
            if not math.isfinite(value):
                raise self._failed(time_s, f"{name}: value {value}: a finite number")
        return values
