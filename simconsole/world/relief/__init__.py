"""The ground of a world as a field of heights: from its roads' lines to a grid."""
