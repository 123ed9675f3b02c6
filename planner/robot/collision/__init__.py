"""Whether arms, body and table are in each other's way."""
