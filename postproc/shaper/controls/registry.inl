// Every control of gear shapers, in the order of messages: the name of its file and of the function in it that makes
// its object.
CONTROL(fanuc)
CONTROL(linuxcnc)
CONTROL(siemens)
