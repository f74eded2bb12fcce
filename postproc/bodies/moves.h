// Do the bodies of a machine keep clear of each other on every move of a program? Proven between the blocks too.
//
// Moves are taken in order, as they were read back, and looked at together: the joints of many moves lie in a box of
// joint space, and a gap at its middle that exceeds the way to its corners (postproc/bodies/scene.h) is a gap on all of
// them. Boxes are halved until the gaps are proven. A tooth, or a turn of a loop, whose joints are those of another one
// but for the turn of the table that carries the work is not looked at again, where that turn moves no gap. Rapids that
// move X and Y, or two rotaries, are boxes themselves: which of the axes arrives first is not known. With TCP the
// linear axes follow the rotaries; what they leave their chord by is an eighth of the second derivative, as in
// postproc/readback/motion.cpp.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/bodies/scene.h"
#include "postproc/readback/reader.h"

namespace toothpath::bodies {

struct MovesOptions {
  double required_mm = 0;    ///< least proven gap that passes; touching never does
  double look_mm = 50;       ///< larger gaps are not told apart
  double share = 0.97;       ///< the proven least gap is no less than this part of the measured one ..
  double apart_mm = 0.1;     ///< .. less this much, and no less than `required_mm` if the true one is not
  double finest_mm = 0.002;  ///< ways of a gap that are not halved again, but where that may still prove it
};

/// Where two bodies come near each other.
struct Meeting {
  std::string first, second;
  Kind first_kind = Kind::machine, second_kind = Kind::machine;
  double proven_mm = 0;    ///< no move of the program has a smaller gap; of a pair that fails: of its first place
  double measured_mm = 0;  ///< found there
  int line = 0, operation = -1, tooth = -1, tool = 0;
  bool rapid = false;
  bool machine_place = false;      ///< on the way to or from a height of the machine's own, which no set-up moves
  machines::Joints joints;         ///< there
  double depth_mm = 0;             ///< of a collision: how far the second must be moved to be free ..
  Vec3 direction = Vec3::UnitZ();  ///< .. in this direction, machine coordinates
  bool neighbours = false;         ///< carried by neighbouring links: they may bear on one another
  /// Of a pair that fails, neither of them the work: how much higher the work must stand on its table so that they keep
  /// apart, and the axes within their limits, wherever the program was looked at. Nothing: no height does.
  std::optional<double> higher_mm;
};

/// What was found about the moves of a program.
struct MovesFound {
  std::size_t stated = 0;  ///< bodies of the machine; 0: nothing was looked at
  std::size_t pairs = 0, moves = 0;
  std::size_t unjudged = 0;          ///< moves from a place that the program does not tell
  std::size_t repeated = 0;          ///< stretches of teeth and turns that repeat another one
  std::vector<std::string> bearing;  ///< pairs that bear on one another and are not looked at
  std::vector<Meeting> nearest;      ///< pairs that come nearer than look_mm, nearest first
  std::vector<Meeting> failed;       ///< first place of every pair that comes too near, in the order of the program
  double required_mm = 0, look_mm = 0;
  [[nodiscard]] bool clear() const { return failed.empty(); }
};

/// Judges executed moves in order.
class MovesJudge {
 public:
  /// The machine must outlive it. @param tool_length_mm gauge line to tip, by T
  MovesJudge(const machines::Machine& machine, std::vector<Body> bodies, std::map<int, double> tool_length_mm,
             const MovesOptions& options);

  void add(const readback::ExecutedMove& move);
  [[nodiscard]] MovesFound finish();

 private:
  using Five = std::array<double, 5>;  // X Y Z mm, rotaries rad
  /// A stretch of the program in joint space.
  struct Span {
    Five from{}, to{};
    double off_mm = 0;                                    // of X Y Z, from the way between `from` and `to` ..
    double off_rad = 0;                                   // .. and of each rotary
    Vec3 tip_from = Vec3::Zero(), tip_to = Vec3::Zero();  // with TCP: table frame
    double length = 0;                                    // of the tool, with TCP
    int line = 0;
    std::int16_t operation = -1, tooth = -1;
    bool rapid = false, box = false, tcp = false;
    bool machine = false;        // its end does not move with the work
    bool machine_place = false;  // it begins or ends at a height of the machine's own
  };
  /// Joints between a least and a greatest, and how far they may be off.
  struct Range {
    Five low{}, high{};
    double off_mm = 0, off_rad = 0;
  };
  struct State {
    double proven, measured;
    std::optional<Meeting> nearest, failed;
    double higher = 0;  // of a pair that fails: how high the work must stand for the spans seen so far
  };
  /// Spans that are looked at together, and a tree of ranges over them.
  struct Batch {
    std::vector<Span> spans;
    std::vector<Range> nodes;
    void build(const MovesJudge& judge, std::size_t node, std::size_t first, std::size_t last);
  };

  [[nodiscard]] Span span_to(const readback::ExecutedMove& move) const;
  [[nodiscard]] Span corner_before(const readback::ExecutedMove& move, const Span& after) const;
  void end_tooth();
  /// Does the tooth that is open repeat one of its operation? Else it is kept, so that later ones may.
  bool repeats();
  [[nodiscard]] bool alike(const Span& a, const Span& b) const;
  /// Does the turn of the link of the work move the gap?
  [[nodiscard]] bool turns(const Pair& pair) const;
  void flush();
  void flush(Batch& batch, bool turned);
  void look_at(std::size_t pair, const Batch& batch);
  void look(std::size_t pair, const Batch& batch, std::size_t node, std::size_t first, std::size_t last);
  void look_closer(std::size_t pair, const Span& span);
  /// How much higher the work must stand for the ends of these spans.
  void raise(std::size_t pair, const Batch& batch);
  /// Is the gap on all of `range` proven to be large enough? Else measured at its middle, where `on_way` says that the
  /// program goes there.
  bool passes(std::size_t pair, const Range& range, const Span* on_way);
  [[nodiscard]] double way(const Pair& pair, const Range& range) const;
  [[nodiscard]] double aim(const State& state) const;
  [[nodiscard]] Meeting meeting(std::size_t pair, const Span& span, const Five& at, const Gap& gap) const;
  [[nodiscard]] Range range_of(const Span& span) const;
  [[nodiscard]] std::pair<Span, Span> halves(std::size_t pair, const Span& span) const;

  const machines::Machine& machine_;
  Scene scene_;
  std::map<int, double> lengths_;
  MovesOptions options_;
  std::vector<State> states_;
  std::size_t turn_ = 5;                                ///< of Five: the joint next to the work, where it is a rotary
  bool any_turned_ = false;                             ///< is there a pair whose gap it moves?
  std::vector<Span> tooth_;                             ///< the one that is open
  Batch fresh_, all_;                                   ///< teeth that repeat none; all, where they matter
  std::map<int, std::vector<std::vector<Span>>> kept_;  ///< teeth of an operation
  std::size_t kept_spans_ = 0;
  std::optional<readback::ExecutedMove> last_, before_;
  double machine_z_ = -INFINITY;  ///< joint: the highest place so far that does not move with the work
  int tool_ = 0;
  std::size_t moves_ = 0, unjudged_ = 0, repeated_ = 0;
};

}  // namespace toothpath::bodies
