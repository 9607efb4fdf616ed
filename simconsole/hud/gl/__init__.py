"""The driver's view on the graphics card, or on a processor that stands in for one: OpenGL 3.3 with moderngl."""
