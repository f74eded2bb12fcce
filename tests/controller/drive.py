"""Drives LinuxCNC's task controller through one program: drive.py PROGRAM.ngc SECONDS. Exit 0: it ran to its end without a message."""
import sys
import time

import linuxcnc

program, limit = sys.argv[1], float(sys.argv[2])
linuxcnc.nmlfile = "linuxcnc.nml"  # of the configuration, where this is started
status, command, errors = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()


def wait(what, seconds, done):
    end = time.time() + seconds
    while time.time() < end:
        try:
            status.poll()
            if done():
                return
        except linuxcnc.error:
            pass
        message = errors.poll()
        if message:
            sys.exit("controller, line %d: %s" % (status.motion_line, message[1].strip()))
        time.sleep(0.02)
    sys.exit("waited %g s for: %s" % (seconds, what))


wait("the task controller", 20, lambda: status.echo_serial_number >= 0)
command.state(linuxcnc.STATE_ESTOP_RESET)
wait("end of the emergency stop", 10, lambda: status.task_state != linuxcnc.STATE_ESTOP)
command.state(linuxcnc.STATE_ON)
wait("machine on", 10, lambda: status.task_state == linuxcnc.STATE_ON)
command.mode(linuxcnc.MODE_MANUAL)
command.wait_complete()
command.teleop_enable(0)
command.home(-1)
wait("home", 20, lambda: all(status.homed[:5]))
command.mode(linuxcnc.MODE_AUTO)
command.wait_complete()
command.program_open(program)
command.wait_complete()
command.auto(linuxcnc.AUTO_RUN, 0)
begin = time.time()
wait("start of the program", 10, lambda: status.interp_state != linuxcnc.INTERP_IDLE)
wait("end of the program", limit, lambda: status.interp_state == linuxcnc.INTERP_IDLE and status.inpos and status.exec_state == linuxcnc.EXEC_DONE)
time.sleep(0.3)
message = errors.poll()
if message:
    sys.exit("controller: " + message[1].strip())
print("executed in %.1f s" % (time.time() - begin))
