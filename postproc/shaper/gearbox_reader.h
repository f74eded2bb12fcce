// Reads a program for an electronic gearbox back and says what the machine would do: ratio, strokes, infeed, turns,
// times. Written from the words of the controls; shares no code with the writer.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toothpath::shaper {

/// Places that agree [mm]: half of the third decimal, the coarser of both controls.
inline constexpr double kPlace = 5.1e-4;

/// Work turns over cutter turns, as the program says them, with its sign.
struct GearboxRatio {
  std::int64_t work_turns = 0, cutter_turns = 0;
};

/// One infeed or turning move while ram and gearbox run.
struct GeneratingMove {
  int line = 0;
  double x_from_mm = 0, x_to_mm = 0;
  std::int64_t cutter_from = 0, cutter_to = 0;  ///< in units of 1e-6 deg
  double minutes = 0;
};

struct GearboxReading {
  std::optional<GearboxRatio> ratio;
  double stroke_start_mm = 0, stroke_end_mm = 0, strokes_per_minute = 0;
  double slide_mm = 0;         ///< Y while cutting
  double clear_before_mm = 0;  ///< X when the coupling goes on
  double clear_after_mm = 0;   ///< X when it goes off
  std::vector<GeneratingMove> moves;
  std::vector<std::string> problems;  ///< words or orders that are wrong whatever the job, "line n: what"
};

/// What the machine file says of axes and M codes.
struct GearboxWords {
  std::string cutter_axis = "C1", work_axis = "C2";
  std::string relief_on, relief_off;
  std::int64_t pulses_per_turn = 0;
};

/// A decimal number as micro-units, exactly; nothing if it has more than six decimals or ten digits before the point,
/// or is no number.
[[nodiscard]] std::optional<std::int64_t> micro(std::string_view text);
/// A whole number with its sign, of at most twelve digits.
[[nodiscard]] std::optional<std::int64_t> whole(std::string_view text);
/// The words of a block, without what stands between them.
[[nodiscard]] std::vector<std::string_view> words_of_block(std::string_view block);

/// State of a control while it reads. Any text gives a reading; what is not understood is a problem. A control adds its
/// own words.
class GearboxReader {
 public:
  explicit GearboxReader(const GearboxWords& words) : w_(words) {}
  virtual ~GearboxReader() = default;
  /// Once.
  [[nodiscard]] GearboxReading run(std::string_view text);

 protected:
  struct MotionWord {
    std::string_view name, number;
  };

  /// A line that frames the program or names it.
  virtual bool frame(std::string_view) { return false; }
  /// At the end of the text.
  virtual void close() {}
  /// Words that the block G17 .. or G21 .. of the safe start must have.
  [[nodiscard]] virtual std::vector<std::string_view> safe_start() const = 0;
  /// Coupling and ram, which only this control says so; false: an ordinary motion.
  virtual bool own_block(std::string_view block) = 0;
  /// A word of a motion that says nothing to the proof.
  [[nodiscard]] virtual bool idle_word(std::string_view) const { return false; }
  /// Name and number of a motion word; nothing: no such word.
  [[nodiscard]] virtual std::optional<MotionWord> split(std::string_view word) const = 0;

  void problem(const std::string& what);
  void set(bool& flag, bool to, const char* what);
  void couple(std::int64_t work, std::int64_t cutter);
  void uncouple();
  /// The ram, from, to [mm], mean speed [mm/min].
  void stroke(double from, double to, double speed);
  void stroke_off() { set(stroking_, false, "ram"); }
  [[nodiscard]] bool coupled() const { return coupled_; }
  [[nodiscard]] bool stroking() const { return stroking_; }

  const GearboxWords& w_;

 private:
  struct Motion;
  void block(std::string_view s);
  void start(std::string_view s);
  void motion(std::string_view s);
  Motion words_of_motion(std::string_view s);
  void check_order(const Motion& m);

  GearboxReading out_;
  int line_ = 0;
  bool started_ = false, first_ = true, ended_ = false, rapid_ = true, inverse_ = false;
  bool coupled_ = false, stroking_ = false, relief_ = false;
  double x_ = -1e9, y_ = 0, z_ = 0;
  std::int64_t cutter_ = 0;
};

}  // namespace toothpath::shaper
