"""Parts: readers that turn a file (STEP, BREP, IGES, STL, OBJ, PLY, 3MF) into arrays, and the part the engine takes."""
