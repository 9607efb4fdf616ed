"""What a real link and a real localisation do to what passes between the console and a controller. Pure."""
