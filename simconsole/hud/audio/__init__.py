"""The sound card: blocks of samples to loudspeakers."""
