#include "tests/support/plain_machine.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace toothpath::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// "section.key" -> text of the value.
std::map<std::string, std::string> values_of(const std::string& text) {
  std::map<std::string, std::string> out;
  std::istringstream in(text);
  std::string section;
  for (std::string line; std::getline(in, line);) {
    line.erase(std::min(line.find('#'), line.size()));
    const auto equal = line.find('=');
    if (!line.empty() && line[0] == '[') section = line.substr(1, line.find(']') - 1) + ".";
    if (equal == std::string::npos) continue;
    const std::string key = line.substr(0, line.find_first_of(" ="));
    out[section + key] = line.substr(equal + 1);
  }
  return out;
}

std::vector<double> numbers_in(std::string text) {
  for (char& c : text)
    if (c == '[' || c == ']' || c == ',') c = ' ';
  std::istringstream in(text);
  std::vector<double> out;
  for (double v = 0; in >> v;) out.push_back(v);
  return out;
}

Vec3 vector_in(const std::string& text) {
  const auto v = numbers_in(text);
  return {v.at(0), v.at(1), v.at(2)};
}

}  // namespace

PlainMachine::PlainMachine(const std::string& machine_file) {
  const auto values = values_of(machine_file);
  const std::string& dialect = values.at("dialect");
  control_ = dialect.substr(dialect.find('"') + 1, dialect.rfind('"') - dialect.find('"') - 1);
  if (const auto p = values.find("post.transformation_takes_rotary_offset"); p != values.end())
    takes_rotary_offset_ = p->second.find("true") != std::string::npos;
  for (const bool head : {false, true})
    for (const char c : values.at(head ? "chain.head" : "chain.table")) {
      if (std::string("ABC").find(c) == std::string::npos) continue;
      const std::string name = std::string("axes.") + c + ".";
      Axis axis;
      axis.index = 3 + std::size_t(c - 'A');
      axis.direction = vector_in(values.at(name + "direction")).normalized();
      if (const auto p = values.find(name + "point"); p != values.end()) axis.point = vector_in(p->second);
      if (const auto p = values.find(name + "pivot_length"); p != values.end())
        axis.point.z() += numbers_in(p->second).at(0);
      if (const auto z = values.find(name + "zero"); z != values.end()) axis.zero = numbers_in(z->second).at(0);
      axis.sign = numbers_in(values.at(name + "sign")).at(0);
      (head ? head_ : table_).push_back(axis);
    }
}

PlainJoints PlainMachine::zeros_and(const std::array<double, 3>& more_deg) const {
  PlainJoints out{};
  for (const Axis& axis : table_) out[axis.index] = axis.zero + more_deg.at(axis.index - 3);
  return out;
}

/// How the tool turns relative to the work.
Mat3 PlainMachine::turn(const Axis& axis, const PlainJoints& joints) const {
  return Eigen::AngleAxisd(axis.sign * (joints[axis.index] - axis.zero) * kDegree, axis.direction).toRotationMatrix();
}

ToolPlace PlainMachine::place(const PlainJoints& joints, double length) const {
  // The head in the ram: from the tool inwards; the gauge point stands in the origin while all rotaries are zero.
  ToolPlace p{Vec3(0, 0, -length), Vec3::UnitZ()};
  for (auto axis = head_.rbegin(); axis != head_.rend(); ++axis) {
    const Mat3 r = turn(*axis, joints);
    p.tip = axis->point + r * (p.tip - axis->point);
    p.axis = r * p.axis;
  }
  p.tip += Vec3(joints[0], joints[1], joints[2]);
  // The table: seen from the work, the tool turns about its outermost axis first.
  for (auto axis = table_.rbegin(); axis != table_.rend(); ++axis) {
    const Mat3 r = turn(*axis, joints);
    p.tip = axis->point + r * (p.tip - axis->point);
    p.axis = r * p.axis;
  }
  return p;
}

Vec3 PlainMachine::on_table(const PlainJoints& joints, Vec3 point) const {
  for (auto axis = table_.rbegin(); axis != table_.rend(); ++axis)
    point = axis->point + turn(*axis, joints) * (point - axis->point);
  return point;
}
Vec3 PlainMachine::off_table(const PlainJoints& joints, Vec3 point) const {
  for (const Axis& axis : table_) point = axis.point + turn(axis, joints).transpose() * (point - axis.point);
  return point;
}

void PlainMachine::bring_tip(PlainJoints& joints, const Vec3& tip, double length) const {
  Vec3 missing = tip - place(joints, length).tip;
  for (const Axis& axis : table_) missing = turn(axis, joints).transpose() * missing;
  for (std::size_t k = 0; k < 3; ++k) joints[k] += missing[Eigen::Index(k)];
}

void PlainMachine::turn_to(PlainJoints& joints, const Vec3& wanted) const {
  const Vec3 axis = wanted.normalized();
  std::vector<std::size_t> free;
  for (const auto* chain : {&table_, &head_})
    for (const Axis& a : *chain) free.push_back(a.index);
  const auto off = [&](const PlainJoints& j) -> Vec3 { return place(j, 0).axis - axis; };
  for (int attempt = 0; attempt < 24; ++attempt) {
    PlainJoints j = joints;
    if (attempt > 0)  // from elsewhere: a pole, or the tool upside down
      for (const std::size_t f : free) j[f] += 37.0 * attempt * (f == free.front() ? 1 : 0.37);
    for (int step = 0; step < 60; ++step) {
      Eigen::Matrix<double, 3, Eigen::Dynamic> slope(3, Eigen::Index(free.size()));
      for (std::size_t k = 0; k < free.size(); ++k) {
        PlainJoints more = j, less = j;
        more[free[k]] += 1e-4;
        less[free[k]] -= 1e-4;
        slope.col(Eigen::Index(k)) = (off(more) - off(less)) / 2e-4;
      }
      const Vec3 now = off(j);
      if (now.norm() < 2e-14) break;
      const Eigen::MatrixXd square = slope.transpose() * slope;
      const Eigen::VectorXd change = (square + 1e-14 * Eigen::MatrixXd::Identity(square.rows(), square.cols()))
                                         .ldlt()
                                         .solve(slope.transpose() * now);
      for (std::size_t k = 0; k < free.size(); ++k) j[free[k]] -= std::clamp(change[Eigen::Index(k)], -20.0, 20.0);
    }
    if (off(j).norm() > 1e-8) continue;
    for (const std::size_t f : free) joints[f] += std::remainder(j[f] - joints[f], 360.0);
    return;
  }
  throw std::runtime_error("no rotaries turn the tool that way");
}

namespace {

double length_of(const PlainSetup& setup, int tool) {
  return tool > 0 && std::size_t(tool) < setup.lengths.size() ? setup.lengths[std::size_t(tool)] : 0;
}

/// Where the control stands, and how words move it.
class OnMachine {
 public:
  OnMachine(const PlainMachine& machine, const PlainSetup& setup) : machine_(machine), setup_(setup) {}

  MachineMove step(const NcMove& n) {
    const double length = length_of(setup_, n.tool);
    MachineMove m;
    m.line = n.line;
    m.tool = n.tool;
    m.rapid = n.rapid;
    m.tip = n.tip;
    m.from = m.to = at_;
    for (std::size_t k = 0; k < 3; ++k)
      if (n.rotary[k]) m.to[3 + k] = *n.rotary[k] + (n.machine ? 0 : n.zero_deg[k]), known_[3 + k] = true;
    if (n.frozen && !frozen_) frozen_ = at_;
    if (!n.frozen) frozen_.reset();
    if (n.granted && machine_.takes_rotary_offset()) frozen_ = machine_.zeros_and(n.zero_deg);
    const auto seen = [&](const Vec3& p) { return frozen_ ? machine_.off_table(*frozen_, p) : p; };
    const auto meant = [&](const Vec3& p) { return frozen_ ? machine_.on_table(*frozen_, p) : p; };
    const Eigen::AngleAxisd frame(n.turned_deg * kDegree, Vec3::UnitZ());
    if (n.direction) {
      machine_.turn_to(m.to, frame * Vec3((*n.direction)[0], (*n.direction)[1], (*n.direction)[2]));
      known_[3] = known_[4] = known_[5] = true;
    }
    if (n.tip) {
      m.tip_from = machine_.place(at_, length).tip;
      Vec3 words = frame.inverse() * (seen(m.tip_from) - setup_.work_offset);
      for (std::size_t k = 0; k < 3; ++k)
        if (n.linear[k]) words[Eigen::Index(k)] = *n.linear[k], known_[k] = true;
      m.tip_to = meant(frame * words + setup_.work_offset);
      machine_.bring_tip(m.to, m.tip_to, length);
    } else {
      for (std::size_t k = 0; k < 3; ++k)
        if (n.linear[k]) {
          m.to[k] = *n.linear[k];
          if (!n.machine) m.to[k] += setup_.work_offset[Eigen::Index(k)] + (k == 2 && n.length ? length : 0);
          known_[k] = true;
        }
    }
    at_ = m.to;
    return m;
  }
  [[nodiscard]] bool knows(const std::array<bool, 6>& needed) const {
    for (std::size_t k = 0; k < 6; ++k)
      if (needed[k] && !known_[k]) return false;
    return true;
  }

 private:
  const PlainMachine& machine_;
  const PlainSetup& setup_;
  PlainJoints at_{};
  std::optional<PlainJoints> frozen_;  // where the rotaries stood when the control took over the tip
  std::array<bool, 6> known_{};
};

}  // namespace

std::vector<MachineMove> moves_on(const PlainMachine& machine, NcWalk& walk, const PlainSetup& setup) {
  std::array<bool, 6> needed{true, true, true, false, false, false};
  for (std::size_t k = 0; k < 3; ++k) {
    PlainJoints turned{};
    turned[3 + k] = 10;
    needed[3 + k] = !(machine.place(turned, 1).tip - machine.place({}, 1).tip).isZero() ||
                    !(machine.place(turned, 1).axis - machine.place({}, 1).axis).isZero();
  }
  OnMachine state(machine, setup);
  std::vector<MachineMove> out;
  for (const NcMove& n : walk.moves) {
    const bool knew = state.knows(needed);
    out.push_back(state.step(n));
    if (knew && (n.rapid || (!n.machine && n.length && n.tool > 0))) continue;
    out.pop_back();
    if (!n.rapid)
      walk.faults.push_back(std::to_string(n.line) + ": a cut from an unknown place, without length or tool");
  }
  return out;
}

ToolPlace place_on(const PlainMachine& machine, const MachineMove& move, const PlainSetup& setup, double t) {
  PlainJoints j = move.from;
  for (std::size_t k = 0; k < 6; ++k) j[k] += t * (move.to[k] - move.from[k]);
  ToolPlace p = machine.place(j, length_of(setup, move.tool));
  if (move.tip) p.tip = move.tip_from + t * (move.tip_to - move.tip_from);
  return p;
}

}  // namespace toothpath::test
