"""Pictures: the OpenGL context, what is drawn through it, and what is read of it."""
