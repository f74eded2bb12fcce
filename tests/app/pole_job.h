// A small spur face gear whose prescribed tool axis comes to the gear axis, the pole of an A/C table, and the program
// of it read by hand.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "tests/app/program.h"
#include "tests/support/trunnion_kinematics.h"

namespace toothpath::test {

struct PoleJob {
  std::string pole = "error";
  std::string machine = "xyzac_large.toml";
  double aside_deg = 0;             ///< of all keys: 0 leads exactly through the pole
  std::optional<double> angle_deg;  ///< pole_angle
  double inner_deg = -3, outer_deg = 3;
};

inline constexpr double kBall = 0.5, kLength = 80;

/// xyzac_large: rotary axes where the part stands. The others turn about the machine zero.
inline Vec3 origin_of(const PoleJob& job) {
  return job.machine.starts_with("xyzac_large") ? Vec3(3, -2, 120) : Vec3(0, 0, 100);
}
inline Vec3 work_offset_of(const PoleJob& job) {
  return job.machine.starts_with("xyzac_large") ? Vec3(3, -2, 0) : Vec3(0, 0, 0);
}

inline std::string job_text(const PoleJob& job) {
  const Vec3 o = origin_of(job), w = work_offset_of(job);
  std::string text =
      "schema = 1\nname = \"pole\"\n"
      "[gear]\ntype = \"face_gear\"\nteeth = 60\nmodule = 2.0\nmodule_plane = \"transverse\"\npressure_angle = "
      "20.0\nshaper_teeth = 20\nshaper_tip_radius = 0.6\n"
      "[[gear.zone]]\nhelix_angle = 0.0\ninner_radius = 60.0\nouter_radius = 63.0\n";
  text += fmt::format("[machine]\nfile = \"{}\"\naccept_assumed = true\n", job.machine);
  text += fmt::format(
      "[setup]\norigin = [{}.0, {}.0, {}.0]\naxis = \"up\"\nwork_offset = \"G54\"\nwork_offset_at = [{}.0, {}.0, "
      "{}.0]\n",
      o.x(), o.y(), o.z(), w.x(), w.y(), w.z());
  text +=
      "[[tool]]\nnumber = 1\ntype = \"ball_end_mill\"\ndiameter = 1.0\nflute_length = 6.0\nshank_diameter = "
      "0.95\nlength = 80.0\nholder = [[10.0, 10.0, 40.0]]\n"
      "stick_out = 16.0\n[[operation]]\ntype = \"finishing\"\ntool = 1\nspeed = 20000\nfeed = 500.0\nscallop = "
      "0.08\nchord_tolerance = 0.002\n";
  text += fmt::format("tool_axis = [[60.8, {:.3f}, {:.4f}], [62.2, {:.3f}, {:.4f}]]\n", job.inner_deg, job.aside_deg,
                      job.outer_deg, job.aside_deg);
  text += fmt::format("[verify]\ngouge_tolerance = 0.003\n[program]\npole = \"{}\"\n", job.pole);
  if (job.angle_deg) text += fmt::format("pole_angle = {:.4f}\n", *job.angle_deg);
  return text;
}

/// Records of cl.csv that are no rapids, as pieces from record to record.
struct PlannedStep {
  Vec3 centre_from, centre_to, axis_from, axis_to;
};
inline std::vector<PlannedStep> planned_steps(const std::string& csv) {
  std::vector<PlannedStep> steps;
  std::istringstream in(csv);
  std::string line, word;
  std::getline(in, line);
  Vec3 centre = Vec3::Zero(), axis = Vec3::Zero();
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::vector<std::string> w;
    while (std::getline(words, word, ',')) w.push_back(word);
    const Vec3 u(std::stod(w[7]), std::stod(w[8]), std::stod(w[9])),
        c = Vec3(std::stod(w[4]), std::stod(w[5]), std::stod(w[6])) + kBall * u;
    if (w[11] != "rapid") steps.push_back({centre, c, axis, u});
    centre = c;
    axis = u;
  }
  return steps;
}

inline double angle_of(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// How far a pose is from the nearest place of the plan; infinite beyond 0.05 mm.
struct FromPlan {
  double centre_mm = INFINITY, axis_rad = INFINITY;
};
inline FromPlan from_plan(const std::vector<PlannedStep>& steps, const Vec3& centre, const Vec3& axis) {
  FromPlan best;
  for (const auto& s : steps) {
    const Vec3 way = s.centre_to - s.centre_from;
    if ((centre - s.centre_from).norm() > way.norm() + 0.05) continue;
    const double t =
        way.squaredNorm() > 0 ? std::clamp((centre - s.centre_from).dot(way) / way.squaredNorm(), 0.0, 1.0) : 1;
    const double off = (centre - s.centre_from - t * way).norm(),
                 turned = angle_of(axis, ((1 - t) * s.axis_from + t * s.axis_to).normalized());
    // Where passes meet, the one whose axis fits.
    if (off < best.centre_mm - 1e-3 || (off < best.centre_mm + 1e-3 && turned < best.axis_rad)) best = {off, turned};
  }
  return best;
}

/// One straight motion of the joints in tooth 0 of a LinuxCNC program: words as they stand, degrees.
struct JointMove {
  std::map<char, double> from, to;
  double minutes = 0;
};
inline std::vector<JointMove> joint_feeds(const std::string& program) {
  std::vector<JointMove> out;
  std::istringstream in(program);
  std::string line;
  std::map<char, double> at;
  bool feed = false, inverse = false;
  double f = 0;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '(' || line[0] == 'o' || line[0] == '#' || line.find("G53") != std::string::npos ||
        line.starts_with("G52") || line.starts_with("G92"))
      continue;
    std::istringstream words(line);
    std::string word;
    std::map<char, double> to = at;
    bool moves = false;
    while (words >> word) {
      if (word == "G0") feed = false;
      if (word == "G1") feed = true;
      if (word == "G93") inverse = true;
      if (word == "G94") inverse = false;
      if (word[0] == 'F') f = std::stod(word.substr(1));
      if (std::string("XYZAC").find(word[0]) == std::string::npos) continue;
      to[word[0]] = std::stod(word.substr(1));
      moves = true;
    }
    if (moves && feed && at.size() == 5) {
      const double way = Vec3(to['X'] - at['X'], to['Y'] - at['Y'], to['Z'] - at['Z']).norm(),
                   turn = std::hypot(to['A'] - at['A'], to['C'] - at['C']);
      out.push_back({at, to, inverse ? 1 / f : (way > 0 ? way : turn) / f});
    }
    at = to;
  }
  return out;
}

/// Pose in the gear frame of the words on xyzac_large, by LinuxCNC's published formulas.
inline TrunnionPose pose_of(const std::map<char, double>& w) {
  const TrunnionGeometry g{3, -2, 0, 14.5, -31.25};
  auto pose = trunnion_forward(g, w.at('X') + 3, w.at('Y') - 2, w.at('Z') + kLength, w.at('A'), w.at('C'), kLength);
  pose.tip -= Vec3(3, -2, 120);
  return pose;
}

}  // namespace toothpath::test
