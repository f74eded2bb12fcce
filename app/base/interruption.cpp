#include "app/base/interruption.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <initializer_list>

#include "geometry/base/printable.h"

namespace toothpath::app {
namespace {

/// What the handler may touch: plain memory, filled before `used` is set.
struct Slot {
  std::array<char, 4096> path{};
  std::atomic<bool> used = false;
  bool is_directory = false;
};
constexpr std::size_t kSlots = 128;
std::array<Slot, kSlots> slots;
/// Two lines: one may be read while the other is written.
struct LastLine {
  std::array<char, 1002> text{};
  std::size_t size = 0;
};
std::array<LastLine, 2> last_lines;
std::atomic<int> last_line = 0;
std::atomic<int> blocked = 0;
std::atomic<bool> pending = false;

static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void remove_temporaries() {
  for (const Slot& slot : slots)
    if (slot.used && !slot.is_directory) ::unlink(slot.path.data());
  for (std::size_t i = kSlots; i-- > 0;)  // the innermost directory was registered last
    if (slots[i].used && slots[i].is_directory) ::rmdir(slots[i].path.data());
}

[[noreturn]] void leave() {
  const LastLine& line = last_lines[static_cast<std::size_t>(last_line)];
  leave_process(line.text.data(), line.size, 130);
}

extern "C" void on_signal(int) {
  if (blocked > 0) pending = true;
  else leave();
}

}  // namespace

void handle_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(number, &action, nullptr);
  action.sa_handler = SIG_IGN;
  for (const int number : {SIGPIPE, SIGXFSZ}) ::sigaction(number, &action, nullptr);
}

bool register_temporary(const std::string& path, bool is_directory) {
  for (Slot& slot : slots) {
    if (slot.used) continue;
    if (path.size() >= slot.path.size()) return false;
    std::memcpy(slot.path.data(), path.c_str(), path.size() + 1);
    slot.is_directory = is_directory;
    slot.used = true;
    return true;
  }
  return false;
}

void forget_temporary(const std::string& path) {
  for (Slot& slot : slots)
    if (slot.used && path == slot.path.data()) slot.used = false;
}

void set_last_line(const std::string& text) {
  const int next = 1 - last_line;
  LastLine& line = last_lines[static_cast<std::size_t>(next)];
  std::string whole = printable(text).substr(0, line.text.size() - 2);
  if (!whole.empty()) whole += '\n';
  if (!whole.empty() && ::isatty(STDERR_FILENO) != 0) whole.insert(0, 1, '\n');  // behind a line of progress
  line.size = whole.size();
  std::memcpy(line.text.data(), whole.data(), whole.size());
  last_line = next;
}

void leave_process(const char* text, std::size_t size, int exit_code) {
  remove_temporaries();
  if (size > 0) (void)!::write(STDERR_FILENO, text, size);
  ::_exit(exit_code);
}

bool SignalsBlocked::any() { return blocked > 0; }
SignalsBlocked::SignalsBlocked() { ++blocked; }
SignalsBlocked::~SignalsBlocked() {
  if (--blocked == 0 && pending) leave();
}

}  // namespace toothpath::app
