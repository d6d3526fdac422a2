"""What the cache of condensed gears saves, and what it asks of the way gears are condensed."""
