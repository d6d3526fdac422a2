"""Tables of a pair's transient contact, with error bars."""
