#include "postproc/restart/parts.h"

#include <map>
#include <optional>

#include "postproc/joints/tooth_order.h"
#include "postproc/restart/fingerprint.h"

namespace toothpath::restart {
namespace {

/// A part while it is compared.
struct Open {
  PartProof proof;
  std::size_t lead = 0, teeth = 0;  ///< moves ahead of its teeth, and of its teeth
  std::size_t own = 0;              ///< of these, all but machine moves
  std::vector<int> labels;          ///< of its teeth, where the text names them
  std::vector<Kept> kept;           ///< of the whole program

  void differs(int line, int whole_line, std::string what) {
    if (!proof.difference.empty()) return;
    proof.line = line;
    proof.whole_line = whole_line;
    proof.difference = std::move(what);
  }
};

class PartsComparison {
 public:
  PartsComparison(std::string_view whole, const std::string& whole_file, std::span<const PartText> parts,
                  const readback::NcControl& control, const joints::AxisProgram& program)
      : whole_(whole), whole_file_(whole_file), parts_(parts), control_(control), program_(program) {}

  Result<std::vector<PartProof>> run() {
    open_.resize(parts_.size());
    for (std::size_t n = 0; n < parts_.size(); ++n) {
      if (auto s = count(n); !s) return s.error();
      of_operation_[parts_[n].part.operation].push_back(n);
    }
    if (auto s = keep(); !s) return s.error();
    judge_teeth();
    for (std::size_t n = 0; n < parts_.size(); ++n)
      if (auto s = compare(n); !s) return s.error();
    std::vector<PartProof> out;
    for (Open& o : open_) out.push_back(std::move(o.proof));
    return out;
  }

 private:
  /// The moves of a part.
  Status count(std::size_t n) {
    Open& o = open_[n];
    std::size_t i = 0, last = 0;
    int label = -1;
    auto s = readback::execute_nc(parts_[n].text, parts_[n].file, control_, [&](const readback::ExecutedMove& m) {
      ++i;
      if (!m.machine) last = i;
      if (!m.machine && o.own++ == 0) o.lead = i - 1;
      if (m.tooth >= 0 && m.tooth != label) o.labels.push_back(m.tooth);
      if (m.tooth >= 0) label = m.tooth;
      if (!m.rapid) o.proof.feed_minutes += m.minutes;
      if (m.operation >= 0 && m.operation != parts_[n].part.operation)
        o.differs(m.line, 0,
                  fmt::format("operation {} in a part of operation {}", m.operation, parts_[n].part.operation));
    });
    o.teeth = last - o.lead;
    if (o.own == 0) o.differs(0, 0, "it cuts nothing");
    return s;
  }

  /// What the whole program does, shared out to the parts: machine moves where one ends and the next begins are theirs.
  Status keep() {
    struct At {
      std::size_t part = 0;  ///< of the operation
      std::optional<Fingerprint> print;
    };
    std::map<int, At> at;
    auto s = readback::execute_nc(whole_, whole_file_, control_, [&](const readback::ExecutedMove& m) {
      if (m.operation < 0) return;
      const auto found = of_operation_.find(m.operation);
      if (found == of_operation_.end()) {
        if (!open_.empty()) open_.front().differs(0, m.line, fmt::format("no part has operation {}", m.operation));
        return;
      }
      At& a = at[m.operation];
      if (a.part < found->second.size()) {
        Open& o = open_[found->second[a.part]];
        if (o.kept.empty() && m.machine) return;
        if (o.kept.empty()) a.print.emplace(control_);
        o.kept.push_back({a.print->of(m), m.line});
        if (o.kept.size() >= o.teeth) ++a.part;
      } else if (!m.machine) {
        open_[found->second.back()].differs(0, m.line, "the whole program goes on where the last part ends");
      }
    });
    for (Open& o : open_)
      if (o.kept.size() < o.teeth)
        o.differs(0, 0, fmt::format("{} moves of teeth where the whole program has {}", o.teeth, o.kept.size()));
    return s;
  }

  /// Every part has the teeth that it is said to have: by their names, or by the number of their moves.
  void judge_teeth() {
    for (const auto& [operation, list] : of_operation_) {
      std::size_t all = 0;
      for (const std::size_t n : list) all += open_[n].own;
      int next = 0;
      for (const std::size_t n : list) {
        const joints::ProgramPart& p = parts_[n].part;
        Open& o = open_[n];
        const int places = p.end_place - p.first_place;
        if (p.first_place != next)
          o.differs(0, 0, fmt::format("begins at place {} where {} is expected", p.first_place, next));
        next = p.end_place;
        if (o.labels.empty()) {
          if (o.own * static_cast<std::size_t>(program_.teeth) != all * static_cast<std::size_t>(places))
            o.differs(0, 0, fmt::format("{} moves are not {} teeth", o.own, places));
          continue;
        }
        std::vector<int> asked;
        for (int k = p.first_place; k < p.end_place; ++k)
          asked.push_back(joints::tooth_of_place(k, program_.tooth_stride, program_.teeth));
        if (o.labels != asked) o.differs(0, 0, "its teeth are not those of the order");
      }
      if (next != program_.teeth)
        open_[list.back()].differs(0, 0, fmt::format("the parts end at place {} of {}", next, program_.teeth));
    }
  }

  Status compare(std::size_t n) {
    Open& o = open_[n];
    std::size_t i = 0;
    Fingerprint own(control_);
    bool cut = false;
    auto s = readback::execute_nc(parts_[n].text, parts_[n].file, control_, [&](const readback::ExecutedMove& m) {
      if (!cut) o.proof.approach.moves.push_back(m);
      cut = cut || !m.rapid;
      const std::size_t at = i++;
      if (at < o.lead || at >= o.lead + o.teeth) {
        if (!m.machine) o.differs(m.line, 0, "a move beside its teeth is no machine move");
        if (at >= o.lead) o.proof.departure.moves.push_back(m);
        return;
      }
      if (at - o.lead >= o.kept.size()) return;
      if (at + 1 == o.lead + o.teeth) o.proof.departure.moves.push_back(m);
      const Kept& k = o.kept[at - o.lead];
      if (own.of(m) != k.print) o.differs(m.line, k.line, "another move than in the whole program");
      if (!m.rapid && !own.all_set(control_)) o.differs(m.line, k.line, "a cut before every axis has had its word");
      ++o.proof.moves;
    });
    for (readback::OperationTrace* trace : {&o.proof.approach, &o.proof.departure}) {
      trace->operation = parts_[n].part.operation;
      trace->tool = trace->moves.empty() ? 0 : trace->moves.back().tool;
      trace->kept_teeth = 1;
    }
    o.proof.approach.lead = o.lead;
    o.kept = {};
    return s;
  }

  std::string_view whole_;
  const std::string& whole_file_;
  std::span<const PartText> parts_;
  const readback::NcControl& control_;
  const joints::AxisProgram& program_;
  std::map<int, std::vector<std::size_t>> of_operation_;
  std::vector<Open> open_;
};

}  // namespace

Result<std::vector<PartProof>> prove_parts(std::string_view whole, const std::string& whole_file,
                                           std::span<const PartText> parts, const readback::NcControl& control,
                                           const joints::AxisProgram& program) {
  return PartsComparison(whole, whole_file, parts, control, program).run();
}

}  // namespace toothpath::restart
