"""`python -m simconsole` is `simconsole`."""

from simconsole.cli.main import main

if __name__ == "__main__":
    raise SystemExit(main())
