"""The rosbridge link: protocol core, messages, topics; server and client."""
