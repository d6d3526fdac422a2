"""Generated pages, and generated parts of pages."""
