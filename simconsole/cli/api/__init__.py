"""The Python API; `simconsole` itself offers it, loaded when it is first asked for."""
