// The programs on which the guarantees of docs/dangers.md are tested: every dialect in every way that it can be posted,
// several jobs.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "tests/postproc/joints/trunnion_post.h"
#include "tests/support/nc_modal_simulator.h"

namespace toothpath::test {

struct Post {
  const char* name;
  const char* dialect;
  machines::TcpMode tcp;
  bool expand;  ///< teeth written out
};

inline const std::vector<Post>& all_posts() {
  static const std::vector<Post> posts = {{"linuxcnc_joints", "linuxcnc", machines::TcpMode::none, false},
                                          {"linuxcnc_joints_teeth", "linuxcnc", machines::TcpMode::none, true},
                                          {"linuxcnc_tcp", "linuxcnc", machines::TcpMode::angles, true},
                                          {"linuxcnc_tcp_turned", "linuxcnc", machines::TcpMode::angles, false},
                                          {"fanuc_joints", "fanuc", machines::TcpMode::none, false},
                                          {"fanuc_joints_teeth", "fanuc", machines::TcpMode::none, true},
                                          {"fanuc_tcp", "fanuc", machines::TcpMode::angles, true},
                                          {"fanuc_tcp_called", "fanuc", machines::TcpMode::angles, false},
                                          {"mitsubishi_joints", "mitsubishi_m80", machines::TcpMode::none, false},
                                          {"mitsubishi_joints_teeth", "mitsubishi_m80", machines::TcpMode::none, true},
                                          {"haas_joints_teeth", "haas", machines::TcpMode::none, true},
                                          {"haas_joints", "haas", machines::TcpMode::none, false},
                                          {"siemens_joints", "siemens", machines::TcpMode::none, false},
                                          {"siemens_joints_teeth", "siemens", machines::TcpMode::none, true},
                                          {"siemens_tcp", "siemens", machines::TcpMode::angles, false},
                                          {"siemens_vectors", "siemens", machines::TcpMode::vectors, false},
                                          {"siemens_vectors_teeth", "siemens", machines::TcpMode::vectors, true},
                                          {"heidenhain_joints", "heidenhain", machines::TcpMode::none, false},
                                          {"heidenhain_joints_teeth", "heidenhain", machines::TcpMode::none, true},
                                          {"heidenhain_tcp", "heidenhain", machines::TcpMode::angles, false},
                                          {"heidenhain_tcp_teeth", "heidenhain", machines::TcpMode::angles, true},
                                          {"heidenhain_vectors", "heidenhain", machines::TcpMode::vectors, true},
                                          {"apt", "apt", machines::TcpMode::vectors, true}};
  return posts;
}

inline machines::Machine machine_of(const Post& p) { return trunnion_with(p.dialect, p.tcp); }

/// What the control would do with a text; a text that it refuses fails the test.
inline std::vector<readback::ExecutedMove> executed(const Post& p, const std::string& text,
                                                    const machines::Machine& m) {
  const auto control = controls::control_of(m, standing(), tools());
  std::vector<readback::ExecutedMove> moves;
  const auto done =
      readback::execute_nc(text, "p", *control, [&](const readback::ExecutedMove& e) { moves.push_back(e); });
  EXPECT_TRUE(done) << p.name << ": " << (done ? "" : done.error().text());
  return moves;
}
inline std::vector<readback::ExecutedMove> executed(const Post& p, const std::string& text) {
  return executed(p, text, machine_of(p));
}

/// Rotaries may move in a cut. Heidenhain without TCP has no feed for it.
inline bool may_turn(const Post& p) {
  return p.tcp != machines::TcpMode::none || std::string(p.dialect) != "heidenhain";
}
inline bool is_iso_point(const Post& p) {
  return std::string(p.dialect) == "fanuc" || std::string(p.dialect) == "mitsubishi_m80" ||
         std::string(p.dialect) == "haas";
}

/// A ball at (100, 0, -3) .. as sample_path, at a lean in the plane of the trunnion: A = lean exactly and C = 0.
inline path::ClPath upright_path(double lean, int operation, int tool, int steps = 6) {
  path::ClPath path = sample_path(0, 0, steps, operation);
  path.tool = tool;
  // u = (sin C sin A, cos C sin A, cos A) on this machine: at C = 0 the axis leans along +Y.
  const Vec3 axis = leaning(lean, kPi / 2);
  for (auto& r : path.records) {
    if (r.kind == path::MoveKind::rapid || r.kind == path::MoveKind::retract)
      r.tip += 12 * (axis / axis.z() - Vec3::UnitZ());
    r.axis = axis;
  }
  return path;
}

/// Jobs of one to three operations with one or two tools.
inline std::map<std::string, std::vector<path::ClPath>> jobs_for(const Post& p) {
  const double swing = may_turn(p) ? 0.2 : 0;
  std::map<std::string, std::vector<path::ClPath>> jobs;
  jobs["one operation"] = {sample_path(0.3, swing, 8)};
  jobs["three operations"] = {sample_path(0.3, swing, 8), sample_path(0, 0, 6, 1), sample_path(0.5, swing, 5, 2)};
  jobs["three operations"][1].tool = 1;
  jobs["A-30, A0, A0"] = {upright_path(radians(-30), 0, 0), upright_path(0, 1, 0), upright_path(0, 2, 1)};
  return jobs;
}

inline constexpr int kDangerTeeth = 3;

inline Result<joints::AxisProgram> program_of(const Post& p, const std::vector<path::ClPath>& paths,
                                              int teeth = kDangerTeeth) {
  return axis_program(paths, machine_of(p), standing(), teeth, p.expand);
}

inline std::string text_of(const Post& p, const std::vector<path::ClPath>& paths, int teeth = kDangerTeeth) {
  const auto t = nc_text(paths, machine_of(p), standing(), teeth, p.expand);
  EXPECT_TRUE(t) << p.name << ": " << (t ? "" : t.error().message);
  return t ? t->text : std::string();
}

/// A test that looks at every post in turn.
class EveryPost : public testing::Test {
 protected:
  template <typename Look>
  void every_post(Look look) {
    for (const Post& p : all_posts()) {
      SCOPED_TRACE(p.name);
      post_ = &p;
      look();
      if (HasFatalFailure()) return;
    }
  }
  [[nodiscard]] const Post& post() const { return *post_; }

 private:
  const Post* post_ = nullptr;
};

}  // namespace toothpath::test
