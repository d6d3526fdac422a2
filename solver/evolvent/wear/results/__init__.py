"""The archive, tables and pictures of a wear study."""
