// What a roll of a gear and its mate found, whatever both are, and its files: both flanks, the exact surface and, where
// it is there, the cut one. The gear carries the grid; its mate is the pinion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/process/ease_off/map.h"
#include "app/process/ease_off/motion.h"
#include "app/process/ease_off/optimiser.h"
#include "app/process/under_load/loaded_contact.h"
#include "geometry/contact/tooth_contact.h"

namespace toothpath::rolled {

/// rad: contact with a smaller transmission error is inside the flank; rounding is a thousand times less, edges far
/// more.
inline constexpr double kNoError = 1e-10;

/// The path of contact in closed form, where there is one.
struct ClosedPath {
  bool line_contact = false;
  double B_rad = 0, error_rad = 0;
  bool on_flanks = false;                       ///< a part of it lies on both flanks:
  double ratio = 0;                             ///< its length in pitches,
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();  ///< its ends, along the teeth and up
};

/// A flank of the gear as it rolled: the grid with what was cut on it.
struct RolledFlank : ease_off::MappedFlank {
  std::vector<double> deviation_mm;   ///< along the normal, > 0 material left
  std::vector<double> turn_rad = {};  ///< of line contact: of the pinion when a place touches; else empty
  std::optional<ClosedPath> path = {};
};
/// Of any flank that rolls.
template <typename Flank>
RolledFlank rolled_flank(const Flank& flank) {
  RolledFlank out{{flank.zone, flank.rows, flank.columns, {}, {}}, flank.deviation_mm};
  for (const Vec3& p : flank.points) {
    const Vec2 at = flank.meridian(p);
    out.x.push_back(at.x());
    out.y.push_back(at.y());
  }
  return out;
}

/// One side of the teeth rolled: a flank a ring.
struct RolledSide {
  int side = 1;
  bool as_cut = false;  ///< the surface that was cut instead of the exact one
  std::string kind;  ///< "point", "line" or "edge": where plain flanks touch; "modified" of flanks that are not plain
  bool modified = false;  ///< a flank of gear or pinion is not plain
  double pitch_rad = 0;   ///< of the gear
  std::vector<RolledFlank> flanks;
  contact::RollResult roll;
  std::optional<contact::EaseOff> ease_off;   ///< none: no place has a common normal
  std::vector<contact::PatternPlace> places;  ///< of the patterns, one a flank; empty without an ease-off
};

/// Of a pinion with involute flanks.
struct InvolutePinion {
  double r_b_mm = 0, r_p_mm = 0, r_a_mm = 0;
};

struct RolledPair {
  const ease_off::PairWords* words = nullptr;
  std::string job_name, job_file;
  std::string mate;                                ///< whose job it is; empty: the mate of the job's own rules
  double shaft_angle_rad = 0, distance_mm = 0;     ///< of the shafts of gears with a job each
  std::string carrier = "gear", other = "pinion";  ///< in words: the gear of the grid, and its mate
  int pinion_teeth = 0, gear_teeth = 0;            ///< of the other and of the carrier
  job::ContactSettings settings;
  double pitch_radius_mm = 0;  ///< lever of the transmission error
  std::optional<InvolutePinion> involute_pinion;
  std::vector<RolledSide> sides;                    ///< +1, -1 exact; then +1, -1 as cut
  std::optional<under_load::LoadedContact> loaded;  ///< where the settings have a load
  ease_off::Misaligned misaligned;
  std::string route;  ///< how the cut surface was made; empty: there is none
  std::vector<std::string> notes;
};
/// A flank of the pair is not plain.
[[nodiscard]] bool is_modified(const RolledPair& pair);
/// The maps of a side, for those that show them. Pair and side must outlive it.
[[nodiscard]] ease_off::SideMap ease_off_of(const RolledPair& pair, const RolledSide& side);
/// Of one pair of its teeth alone.
[[nodiscard]] ease_off::MotionCurve motion_of(const RolledSide& side);

/// Does contact stay inside the flanks, off all edges, without load and under that of the job? In a few words.
struct Verdict {
  bool inside = false;
  std::string words;
};
[[nodiscard]] Verdict verdict_of(const RolledPair& pair);

/// "offset +0.1 mm, angle +0 deg, axial +0 mm".
[[nodiscard]] std::string words_of(const contact::Misalignment& moved);

/// contact.csv: every place of every flank with its gap, and its place on the pinion.
[[nodiscard]] std::string contact_csv(const RolledPair& pair);
/// transmission.csv: one pitch of positions, both sides, exact and as cut.
[[nodiscard]] std::string transmission_csv(const RolledPair& pair);
/// contact.json, ending in a line feed.
[[nodiscard]] std::string contact_json(const RolledPair& pair);
/// For the screen.
[[nodiscard]] std::string contact_summary(const RolledPair& pair);

}  // namespace toothpath::rolled
