"""Pack for motions of arms: named motions, and plans under the names of MoveIt."""
