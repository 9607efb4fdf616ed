"""Where clients of this machine reach a server."""


def reached_here(url: str) -> str:
    """Return the address for this machine of a server that listens on all addresses: no certificate names those."""
    return url.replace("//0.0.0.0:", "//127.0.0.1:").replace("//[::]:", "//[::1]:")
