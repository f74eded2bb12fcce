// The study of nine trials as independent samples: each trial, each with halves of one width, each effort of trial 4.
// A sample is computed by its number alone and stands as one line of JSON in the file of its shard.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/studies/samples/sample_file.h"
#include "app/studies/trials/dhfg_loaded.h"
#include "app/studies/trials/dhfg_trial.h"

namespace toothpath::trials {

inline constexpr const char* kDhfg = "dhfg";
inline constexpr int kDhfgVersion = 2;          ///< of what a sample means: another one, other samples
inline constexpr std::size_t kMiddleTrial = 3;  ///< trial 4, whose effort is varied, from 0

/// What the tables need of a study besides its samples: the head of its shards.
struct StudyFacts {
  std::string name;
  bool quick = false;  ///< with coarse tolerances
  bool milled = false;
  double module_mm = 0;
  bool normal_module = true;
  std::vector<double> pinion_teeth, ratio, helix_angle_rad;
  double torque_nmm = 0, held_share = 0, rapid_mm_min = 0;
  double equal_half_mm = 0;  ///< narrowest feasible half of the nine; 0: a trial is not feasible, and they are left out
  int efforts = 0;           ///< 0: trial 4 is not feasible
};

/// What the study found, by sample.
struct StudyFound {
  std::vector<DhfgTrial> trials;
  EqualHalves equal;
  std::vector<EffortRow> efforts;
};

/// Samples of a study with these facts; room for all of them.
[[nodiscard]] int count_of(const StudyFacts& facts);
[[nodiscard]] StudyFound room_for(const StudyFacts& facts);
/// Sample k of `found` as a line; without its run time, which is another one on every machine.
[[nodiscard]] std::string sample_line(const StudyFacts& facts, int k, const StudyFound& found);
/// @param inputs  digest of all files that the study was read from
[[nodiscard]] samples::Head head_of(const StudyFacts& facts, const std::string& inputs);

/// The study and what its samples share: limits of all trials.
class DhfgSamples {
 public:
  DhfgSamples(DhfgStudy study, bool quick);

  [[nodiscard]] const StudyFacts& facts() const { return facts_; }
  [[nodiscard]] int count() const { return count_of(facts_); }
  /// Of sample k: "trial 4", "trial 4 with equal halves", "effort 2 of trial 4".
  [[nodiscard]] std::string name(int k) const;
  [[nodiscard]] StudyFound room() const { return room_for(facts_); }
  /// Fills sample k in. Nothing is refused: what does not work stands in the sample.
  void compute(int k, StudyFound& found) const;
  [[nodiscard]] std::string line(int k, const StudyFound& found) const { return sample_line(facts_, k, found); }
  [[nodiscard]] samples::Head head(const std::string& inputs) const { return head_of(facts_, inputs); }

 private:
  DhfgStudy study_;
  StudyFacts facts_;
  std::optional<face_gear::FaceGear> middle_;
};

struct MergedStudy {
  StudyFacts facts;
  StudyFound found;
};
/// From head and lines. Errors: what `study dhfg` does not write, with file and line.
[[nodiscard]] Result<MergedStudy> study_of(const samples::Merged& merged);

}  // namespace toothpath::trials
