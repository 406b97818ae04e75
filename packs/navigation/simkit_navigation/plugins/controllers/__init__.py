"""Controllers of Nav2, with their critics and their checkers of goals and of progress."""
