"""Software renderer: draws MuJoCo's list of shapes with OpenCV's triangle rasteriser, without OpenGL.

The pictures have the same bits on every x86-64-v3 processor. For this, the package calls no BLAS and no array function
of NumPy whose code depends on the processor (`exp`, `power`, `arctan2`, `tan`). Sums of three products are written out.
"""
