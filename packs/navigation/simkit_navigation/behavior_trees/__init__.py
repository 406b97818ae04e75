"""Behaviour trees of Nav2 in the XML of BehaviorTree.CPP: reader, nodes, and the default trees."""
