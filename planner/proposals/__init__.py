"""Ways to fold a garment to a size, and what the robot makes of them."""
