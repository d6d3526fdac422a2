"""The line contact of a gear pair: loads per length of the contact lines, on condensed gears (docs/line_contact.md)."""
