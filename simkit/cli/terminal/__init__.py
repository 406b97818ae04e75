"""Everything that several commands share: options, output, completion, keyboard, and where topics are read from."""
