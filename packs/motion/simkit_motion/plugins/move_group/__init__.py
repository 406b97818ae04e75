"""Motion planning for arms under the names of MoveIt's node `move_group`: kinematics, collision-free plans, execution.

The packages `pin` (Pinocchio) and `coal` do the calculations. They are imported at the first request.
"""
