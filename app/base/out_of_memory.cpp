#include "app/base/out_of_memory.h"

#include <unistd.h>

#include <cstring>
#include <exception>
#include <mutex>
#include <new>

#include "app/base/exit_code.h"
#include "app/base/interruption.h"

namespace toothpath::app {
namespace {

std::string answer;
std::mutex ending;

[[noreturn]] void end_with(const char* message) {
  ending.lock();  // the first thread that comes here speaks, and never gives it back
  if (!answer.empty()) (void)!::write(STDOUT_FILENO, answer.data(), answer.size());
  char line[512] = "error: ";
  const std::size_t begin = std::strlen(line), size = std::min(std::strlen(message), sizeof line - begin - 1);
  std::memcpy(line + begin, message, size);
  line[begin + size] = '\n';
  leave_process(line, begin + size + 1, static_cast<int>(ExitCode::internal));
}

void on_no_memory() {
  if (SignalsBlocked::any()) throw std::bad_alloc();
  end_with(kOutOfMemory);
}

[[noreturn]] void on_terminate() {
  try {
    if (const auto current = std::current_exception()) std::rethrow_exception(current);
  } catch (const std::bad_alloc&) { end_with(kOutOfMemory); } catch (const std::exception& error) {
    end_with(error.what());
  } catch (...) {}
  end_with("internal error: an exception that nobody caught");
}

}  // namespace

void handle_out_of_memory() {
  std::set_new_handler(on_no_memory);
  std::set_terminate(on_terminate);
}

void set_out_of_memory_answer(std::string text) { answer = std::move(text); }

}  // namespace toothpath::app
