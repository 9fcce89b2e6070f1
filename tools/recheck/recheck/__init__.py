"""A second check of reachtube's verdicts, which shares no code with the first."""
