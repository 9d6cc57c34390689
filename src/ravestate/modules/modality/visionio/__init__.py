"""What the agent sees: faces, and the people to whom they belong."""
