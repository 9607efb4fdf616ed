"""What pictures of a drive are made of, in whichever process draws them."""
