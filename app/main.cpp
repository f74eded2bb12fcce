#include "app/base/interruption.h"
#include "app/base/out_of_memory.h"
#include "app/command_line.h"

int main(int argc, char** argv) {
  toothpath::app::handle_signals();
  toothpath::app::handle_out_of_memory();
  toothpath::app::set_state("nothing was written");
  return toothpath::run_command_line(argc, argv);
}
