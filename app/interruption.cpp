#include "app/interruption.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <initializer_list>

namespace toothpath {
namespace {

/// What the handler may touch: plain memory, filled before `used` is set.
struct Slot {
  std::array<char, 4096> path{};
  std::atomic<bool> used = false;
  bool is_directory = false;
};
constexpr std::size_t kSlots = 128;
std::array<Slot, kSlots> slots;
std::atomic<int> blocked = 0;
std::atomic<bool> pending = false;

static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

[[noreturn]] void leave() {
  for (const Slot& slot : slots)
    if (slot.used && !slot.is_directory) ::unlink(slot.path.data());
  for (std::size_t i = kSlots; i-- > 0;)  // the innermost directory was registered last
    if (slots[i].used && slots[i].is_directory) ::rmdir(slots[i].path.data());
  ::_exit(130);
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

SignalsBlocked::SignalsBlocked() { ++blocked; }
SignalsBlocked::~SignalsBlocked() {
  if (--blocked == 0 && pending) leave();
}

}  // namespace toothpath
