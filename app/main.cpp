#include "app/command_line.h"
#include "app/interruption.h"

int main(int argc, char** argv) {
  toothpath::handle_signals();
  return toothpath::run_command_line(argc, argv);
}
