"""Pack with cameras for labels, bounding boxes, temperatures and wide angles."""
