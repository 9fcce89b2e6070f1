"""The error that ends a run: input that cannot be judged."""


class BadInput(Exception):
    """A file or an option that cannot be judged; the message names it and says what to do."""
