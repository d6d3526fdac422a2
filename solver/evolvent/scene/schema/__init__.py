"""The keys of a scene file, and the messages on wrong ones."""
