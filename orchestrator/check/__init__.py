"""Does an FMU keep the port contract? What is written in its description, and what it does when it is driven. Knows no physics."""
