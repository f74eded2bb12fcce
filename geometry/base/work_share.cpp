#include "geometry/base/work_share.h"

#include <algorithm>
#include <mutex>

namespace toothpath {
namespace {

thread_local WorkShare* innermost = nullptr;

/// Of all lists of parts: they change a few times a second.
std::mutex& parts_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

WorkShare::WorkShare(double pieces, double worth)
    : around_(innermost), before_(innermost), pieces_(pieces), worth_(worth) {
  begin();
}

WorkShare::WorkShare(WorkShare& around, double pieces, double worth)
    : around_(&around), before_(innermost), pieces_(pieces), worth_(worth) {
  begin();
}

void WorkShare::begin() {
  innermost = this;
  if (!around_) return;
  const std::lock_guard lock(parts_mutex());
  around_->parts_.push_back(this);
}

WorkShare::~WorkShare() {
  innermost = before_;
  if (!around_) return;
  const std::lock_guard lock(parts_mutex());
  around_->parts_.erase(std::find(around_->parts_.begin(), around_->parts_.end(), this));
  around_->add(worth_);
}

double WorkShare::done() const {
  const std::lock_guard lock(parts_mutex());
  return done_locked();
}

double WorkShare::done_locked() const {
  double sum = done_.load(std::memory_order_relaxed);
  for (const WorkShare* part : parts_) sum += part->worth_ * part->done_locked();
  return pieces_ > 0 ? std::clamp(sum / pieces_, 0.0, 1.0) : 0;
}

}  // namespace toothpath
