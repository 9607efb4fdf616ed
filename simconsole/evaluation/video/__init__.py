"""A recorded drive as pictures: frames at any rate, drawn without a window, as a video or as one PNG."""
