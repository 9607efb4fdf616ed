"""Lets the console, and only the console, believe that it runs on another system. Python imports this at its start.

SIMCONSOLE_TEST_PLATFORM says which: win32 or darwin. What the modules of simconsole import is then without the modules,
functions and constants that this system lacks (docs.python.org, "Availability"), and has its name; the libraries around
them, which really run on Linux, see no difference. It holds for every process that inherits the environment.
"""

import builtins
import ctypes
import os
import pathlib
import signal
import sys
import types
from typing import Any

LINUX_ONLY = {
    "os": "sched_* SCHED_* posix_fadvise POSIX_* posix_fallocate fdatasync memfd_create eventfd* splice "
    "copy_file_range getrandom setxattr getxattr O_DIRECT O_TMPFILE O_PATH pidfd_open pipe2 getresuid setns unshare",
    "signal": "SIGRTMIN SIGRTMAX SIGPWR SIGSTKFLT SIGCLD SIGPOLL sigwaitinfo sigtimedwait pidfd_send_signal",
    "select": "epoll EPOLL*",
    "socket": "AF_CAN CAN_* AF_NETLINK AF_PACKET AF_VSOCK SO_BINDTODEVICE",
}
POSIX_ONLY = {
    "os": "chown fchmod fchown fork forkpty getegid geteuid getgid getgroups getloadavg getpgid getpgrp getpriority "
    "getsid getuid initgroups kill killpg lchown lockf major makedev minor mkfifo mknod nice openpty pread preadv "
    "pwrite pwritev readv writev register_at_fork sendfile setsid setpgid setpriority statvfs "
    "fstatvfs sync sysconf ttyname uname wait wait3 wait4 waitid posix_spawn posix_spawnp fchdir fpathconf O_NONBLOCK "
    "O_CLOEXEC O_NOFOLLOW O_DIRECTORY O_SYNC O_DSYNC O_NOCTTY O_NDELAY WNOHANG",
    "signal": "SIGHUP SIGKILL SIGUSR1 SIGUSR2 SIGCHLD SIGALRM SIGPIPE SIGQUIT SIGSTOP SIGCONT SIGTSTP SIGWINCH alarm "
    "pause setitimer getitimer siginterrupt pthread_kill pthread_sigmask sigpending sigwait",
    "select": "poll POLL* devpoll kqueue",
    "socket": "AF_UNIX SO_REUSEPORT MSG_DONTWAIT MSG_NOSIGNAL CMSG_LEN",
}
POSIX_MODULES = {"fcntl", "termios", "tty", "pty", "resource", "pwd", "grp", "syslog", "posix", "readline", "curses"}
LINUX_MODULES = {"spwd", "ossaudiodev"}
LINUX_FOLDERS = ("/dev/shm", "/dev/input", "/proc", "/sys")


class Foreign(types.ModuleType):
    """A module of the standard library as another system has it."""

    def __init__(self, real: types.ModuleType, hidden: list[str], instead: dict[str, Any]) -> None:
        super().__init__(real.__name__)
        self.__dict__.update(_real=real, _hidden=hidden, _instead=instead)

    def __getattr__(self, name: str) -> Any:
        """The real one's, unless the system has it not or has it differently."""
        if name in self._instead:
            return self._instead[name]
        for pattern in self._hidden:
            if name == pattern or (pattern.endswith("*") and name.startswith(pattern[:-1])):
                raise AttributeError(f"module {self.__name__!r} has no attribute {name!r} on this system")
        return getattr(self._real, name)

    def __setattr__(self, name: str, value: Any) -> None:
        """There is one state."""
        setattr(self._real, name, value)


class Kernel32:
    """What the console asks of Windows' kernel32.dll: whether a process lives."""

    def __init__(self, name: str, use_last_error: bool = False) -> None:
        assert name == "kernel32"

    def OpenProcess(self, access: int, inherit: bool, process_id: int) -> int:  # noqa: N802  # Windows' names
        return process_id if os.access(f"/proc/{process_id}", os.F_OK) else 0

    def WaitForSingleObject(self, handle: int, wait_ms: int) -> int:  # noqa: N802
        return 0x102

    def CloseHandle(self, handle: int) -> int:  # noqa: N802
        return 1


def pretend(platform: str) -> None:
    """From here on modules of simconsole see another system."""
    windows = platform == "win32"
    hidden = {name: text.split() + (POSIX_ONLY[name].split() if windows else []) for name, text in LINUX_ONLY.items()}
    instead: dict[str, dict[str, Any]] = {"sys": {"platform": platform}}
    if windows:
        instead["os"] = {"name": "nt", "O_BINARY": 0}
        ctypes.WinDLL, ctypes.get_last_error = Kernel32, lambda: 87  # type: ignore[attr-defined]
    modules = {
        real.__name__: Foreign(real, hidden.get(real.__name__, []), instead.get(real.__name__, {}))
        for real in (os, sys, signal, __import__("select"), __import__("socket"))
    }
    missing = LINUX_MODULES | (POSIX_MODULES if windows else set())
    import_ = builtins.__import__

    def foreign_import(name: str, importer: Any = None, *rest: Any, **named: Any) -> types.ModuleType:
        importer = named.get("globals") if importer is None else importer
        # The spec has the whole name, also of a program that `python -m` runs; no path tells ours from a library's.
        spec, own_name = (importer or {}).get("__spec__"), str((importer or {}).get("__name__", ""))
        ours = (spec.name if spec else own_name).partition(".")[0] == "simconsole"
        if ours and name.partition(".")[0] in missing:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        words = (importer, *rest) if "globals" not in named else ()
        return modules[name] if ours and name in modules else import_(name, *words, **named)

    builtins.__import__ = foreign_import  # type: ignore[assignment]  # Python calls it with one to five words
    for name in ("is_dir", "exists"):
        setattr(pathlib.Path, name, without_linux_folders(getattr(pathlib.Path, name)))


def without_linux_folders(asks: Any) -> Any:
    """Nobody has /proc there."""
    return lambda path, *words, **options: not str(path).startswith(LINUX_FOLDERS) and asks(path, *words, **options)


if os.environ.get("SIMCONSOLE_TEST_PLATFORM"):
    pretend(os.environ["SIMCONSOLE_TEST_PLATFORM"])
