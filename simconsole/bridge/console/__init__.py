"""What the console says and hears over rosbridge: topics, commands, an operator's acts. No socket."""
