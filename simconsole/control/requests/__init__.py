"""What the person and the controller ask for, checked and in common terms: the inputs of arbitration."""
