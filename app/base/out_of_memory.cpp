#include "app/base/out_of_memory.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>

#include "app/base/exit_code.h"
#include "app/base/interruption.h"

namespace toothpath::app {
namespace {

constexpr std::size_t kExchangeBytes = std::size_t(8) << 20;  // names, a block of a file, the words of the end

std::string answer, answer_at_the_end;
std::atomic<bool> results_written = false;
std::mutex ending;

[[noreturn]] void end_with(const char* message) {
  ending.lock();  // the first thread that comes here speaks, and never gives it back
  const std::string& said = results_written ? answer_at_the_end : answer;
  if (!said.empty()) (void)!::write(STDOUT_FILENO, said.data(), said.size());
  char line[512] = "error: ";
  const std::size_t begin = std::strlen(line), size = std::min(std::strlen(message), sizeof line - begin - 1);
  std::memcpy(line + begin, message, size);
  line[begin + size] = '\n';
  leave_process({line, begin + size + 1}, "note: ", static_cast<int>(ExitCode::internal));
}

[[noreturn]] void end_without_memory() { end_with(results_written ? kOutOfMemoryAtTheEnd : kOutOfMemory); }

void on_no_memory() {
  if (SignalsBlocked::any()) throw std::bad_alloc();
  end_without_memory();
}

[[noreturn]] void on_terminate() {
  try {
    if (const auto current = std::current_exception()) std::rethrow_exception(current);
  } catch (const std::bad_alloc&) { end_without_memory(); } catch (const std::exception& error) {
    end_with(words_of(error).c_str());
  } catch (...) {}
  end_with("internal error: an exception that nobody caught");
}

}  // namespace

void handle_out_of_memory() {
  std::set_new_handler(on_no_memory);
  std::set_terminate(on_terminate);
}

void require_memory() {
  void* place = ::operator new(kExchangeBytes);
  *static_cast<volatile char*>(place) = 0;  // so that no compiler leaves the pair out
  ::operator delete(place);
}

void note_results_written() { results_written = true; }

void set_out_of_memory_answers(std::string text, std::string at_the_end) {
  answer = std::move(text);
  answer_at_the_end = std::move(at_the_end);
}

std::string words_of(const std::exception& error) {
  const std::string what = error.what();
  if (what.find("pthread_create") != std::string::npos)  // of TBB
    return "out of memory: nothing was written; a thread cannot be started: a limit of this shell (ulimit -v, ulimit "
           "-u), or fewer --threads";
  return "internal error: " + what;
}

}  // namespace toothpath::app
