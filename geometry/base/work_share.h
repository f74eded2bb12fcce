// How far a long computation has come, for whoever shows it: kernels say how many pieces their work has and count them.
// What nobody watches costs two atomic additions a piece.
#pragma once

#include <atomic>
#include <vector>

namespace toothpath {

/// Work of a number of pieces, as long as it lives. The first one on a thread is the whole; one that is made while
/// another lives on the same thread is a part of it. On another thread than its whole it names it.
class WorkShare {
 public:
  /// @param pieces  of this work, in any unit
  /// @param worth   how many pieces of the work around it it is; they count as done when it ends
  explicit WorkShare(double pieces, double worth = 1);
  /// A part of `around`, on any thread.
  explicit WorkShare(WorkShare& around, double pieces = 1, double worth = 1);
  ~WorkShare();
  WorkShare(const WorkShare&) = delete;
  WorkShare& operator=(const WorkShare&) = delete;

  /// From any thread.
  void add(double pieces = 1) { done_.fetch_add(pieces, std::memory_order_relaxed); }
  /// 0 to 1, with the parts that are under way; from any thread.
  [[nodiscard]] double done() const;

 private:
  void begin();
  [[nodiscard]] double done_locked() const;

  WorkShare* const around_;
  WorkShare* const before_;  ///< of this thread
  const double pieces_, worth_;
  std::atomic<double> done_ = 0;
  std::vector<const WorkShare*> parts_;
};

}  // namespace toothpath
