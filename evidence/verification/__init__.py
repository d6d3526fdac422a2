"""Problems with a known answer, each solved and compared with it."""
