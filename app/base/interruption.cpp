#include "app/base/interruption.h"

#include <fcntl.h>
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
  int directory = 0;
  std::array<char, 4096> name{};
  std::atomic<bool> used = false;
  bool is_directory = false;
};
constexpr std::size_t kSlots = 128;
std::array<Slot, kSlots> slots;
/// Two lines: one may be read while the other is written.
struct StandingLine {
  std::array<char, 1002> text{};
  std::size_t size = 0;
};
std::array<StandingLine, 2> standing_lines;
std::atomic<int> standing_line = 0;
std::atomic<bool> on_terminal = false;
std::atomic<int> blocked = 0;
std::atomic<bool> pending = false;

static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void remove_temporaries() {
  for (const Slot& slot : slots)
    if (slot.used && !slot.is_directory) ::unlinkat(slot.directory, slot.name.data(), 0);
  for (std::size_t i = kSlots; i-- > 0;)  // the innermost directory was registered last
    if (slots[i].used && slots[i].is_directory) ::unlinkat(slots[i].directory, slots[i].name.data(), AT_REMOVEDIR);
}

void to_stderr(std::string_view text) { (void)!::write(STDERR_FILENO, text.data(), text.size()); }

[[noreturn]] void leave() {
  leave_process(on_terminal ? "\n" : "", "interrupted: ", 130);  // behind a line of progress
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
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    if (::sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;  // nohup
    ::sigaction(number, &action, nullptr);
  }
  action.sa_handler = SIG_IGN;
  for (const int number : {SIGPIPE, SIGXFSZ}) ::sigaction(number, &action, nullptr);
}

bool register_temporary(int directory, const std::string& name, bool is_directory) {
  for (Slot& slot : slots) {
    if (slot.used) continue;
    if (name.size() >= slot.name.size()) return false;
    slot.directory = directory;
    std::memcpy(slot.name.data(), name.c_str(), name.size() + 1);
    slot.is_directory = is_directory;
    slot.used = true;
    return true;
  }
  return false;
}

void forget_temporary(int directory, const std::string& name) {
  for (Slot& slot : slots)
    if (slot.used && slot.directory == directory && name == slot.name.data()) slot.used = false;
}

void set_state(const std::string& text) {
  const int next = 1 - standing_line;
  StandingLine& line = standing_lines[static_cast<std::size_t>(next)];
  std::string whole = printable(text).substr(0, line.text.size() - 2);
  if (!whole.empty()) whole += '\n';
  on_terminal = ::isatty(STDERR_FILENO) != 0;
  line.size = whole.size();
  std::memcpy(line.text.data(), whole.data(), whole.size());
  standing_line = next;
}

void leave_process(std::string_view text, std::string_view before_state, int exit_code) {
  remove_temporaries();
  to_stderr(text);
  if (const StandingLine& line = standing_lines[static_cast<std::size_t>(standing_line)]; line.size > 0) {
    to_stderr(before_state);
    to_stderr({line.text.data(), line.size});
  }
  ::_exit(exit_code);
}

bool SignalsBlocked::any() { return blocked > 0; }
SignalsBlocked::SignalsBlocked() { ++blocked; }
SignalsBlocked::~SignalsBlocked() {
  if (--blocked == 0 && pending) leave();
}

}  // namespace toothpath::app
