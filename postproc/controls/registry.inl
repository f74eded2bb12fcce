// Every control, in the order of messages: the name of its folder and of the function in it that makes its object.
CONTROL(linuxcnc)
CONTROL(fanuc)
CONTROL(siemens)
CONTROL(heidenhain)
CONTROL(apt)
CONTROL(mitsubishi_m80)
CONTROL(haas)
