"""What the console sends and accepts over rosbridge: topics, commands, an operator's acts. No socket."""
