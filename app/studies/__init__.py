"""Studies: many tasks planned at once, as the product of what varies between them."""
