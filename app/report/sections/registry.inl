// Every section, in the order of the set-up sheet: the name of its file and of the function in it.
SECTION(travels)
SECTION(modifications)
SECTION(machine_moves)
SECTION(times)
SECTION(side_passes)
SECTION(tool_work)
SECTION(engagement)
SECTION(cutting_force)
