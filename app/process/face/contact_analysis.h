// Everything about the contact of one job's gear with its pinion: both flanks, the exact surface and, where it is
// there, the cut one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/process/cut_flanks.h"
#include "app/process/ease_off/map.h"
#include "app/process/ease_off/motion.h"
#include "app/process/ease_off/optimiser.h"
#include "app/process/face/loaded_contact.h"
#include "app/process/gear_of_job.h"
#include "geometry/contact/tooth_contact.h"

namespace toothpath::face {

/// rad: contact with a smaller transmission error is inside the flank; rounding is a thousand times less, edges far
/// more.
inline constexpr double kNoError = 1e-10;

/// One side of the teeth rolled against the pinion: a member a ring.
struct ContactOfSide {
  int side = 1;
  bool as_cut = false;  ///< the surface that was cut instead of the exact one
  std::string kind;  ///< "point", "line" or "edge": where plain flanks touch; "modified" of flanks that are not plain
  std::vector<contact::ContactMember> members;
  std::vector<std::optional<contact::ContactPath<double>>> paths;  ///< closed form, of the exact surface; one a member
  std::vector<std::optional<contact::PathRange>> ranges;           ///< its part on both flanks
  contact::RollResult roll;
  std::optional<contact::EaseOff> ease_off;   ///< none: no place has a common normal
  std::vector<contact::PatternPlace> places;  ///< of the patterns, one a member; empty without an ease-off
};
/// Its maps, for those that show them. The side must outlive it.
[[nodiscard]] ease_off::SideMap ease_off_of(const ContactOfSide& side);
/// Of one pair of its teeth alone.
[[nodiscard]] ease_off::MotionCurve motion_of(const ContactOfSide& side);

struct ContactAnalysis {
  std::string job_name, job_file;
  int pinion_teeth = 0, gear_teeth = 0;
  job::ContactSettings settings;
  double pitch_radius_mm = 0, base_radius_mm = 0;  ///< L_p and M2: levers of the transmission error
  double pinion_r_b_mm = 0, pinion_r_p_mm = 0, pinion_r_a_mm = 0;
  std::vector<ContactOfSide> sides;                 ///< +1, -1 exact; then +1, -1 as cut
  std::optional<under_load::LoadedContact> loaded;  ///< where the settings have a load
  ease_off::Misaligned misaligned;
  std::string route;  ///< how the cut surface was made; empty: there is none
  std::vector<std::string> notes;
};
/// A flank of the pair is not plain.
[[nodiscard]] bool is_modified(const ContactAnalysis& analysis);

/// Does contact stay inside the flanks, off all edges, without load and under that of the job? In a few words.
struct ContactVerdict {
  bool inside = false;
  std::string words;
};
[[nodiscard]] ContactVerdict verdict_of(const ContactAnalysis& analysis);

struct ContactGrid {
  int rows = 41, columns = 49;  ///< of the exact flank
  int steps = 48;               ///< positions a pitch
};

/// "offset +0.1 mm, angle +0 deg, axial +0 mm".
[[nodiscard]] std::string words_of(const contact::Misalignment& moved);

/// Refused: a pinion that cannot run (place: contact.pinion_teeth or gear.mate_teeth); a flank that is not there; a
/// pinion out of reach.
[[nodiscard]] process::ValueOrErrors<ContactAnalysis> analyse_contact(const job::Job& job,
                                                                      const face_gear::FaceGear& gear,
                                                                      const job::ContactSettings& settings,
                                                                      const process::CutFlanks* cut,
                                                                      const ContactGrid& grid = {});

/// contact.csv: every place of every flank with its gap, and its place on the pinion.
[[nodiscard]] std::string contact_csv(const ContactAnalysis& analysis);
/// transmission.csv: one pitch of positions, both sides, exact and as cut.
[[nodiscard]] std::string transmission_csv(const ContactAnalysis& analysis);
/// contact.json, ending in a line feed.
[[nodiscard]] std::string contact_json(const ContactAnalysis& analysis);
/// For the screen.
[[nodiscard]] std::string contact_summary(const ContactAnalysis& analysis);

}  // namespace toothpath::face
