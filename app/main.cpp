#include "app/command_line.h"
#include "app/interruption.h"

int main(int argc, char** argv) {
  toothpath::handle_signals();
  toothpath::set_last_line("interrupted: nothing was written");
  return toothpath::run_command_line(argc, argv);
}
