"""What commands say of words that they do not know."""
