"""What the plugins that command joints share."""
