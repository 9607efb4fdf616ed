"""The rosbridge protocol of servers and clients, without a socket."""
