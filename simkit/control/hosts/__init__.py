"""The plugins that host a controller manager; what they need is imported once one is used."""
