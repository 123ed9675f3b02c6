"""The values: what is asked, what is answered, and the numbers of the world between them."""
