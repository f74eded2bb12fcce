#include "postproc/restart/proof.h"

#include <limits>
#include <vector>

#include "postproc/readback/operation_moves.h"
#include "postproc/restart/fingerprint.h"

namespace toothpath::restart {
namespace {

/// Moves of a text, and those of one operation.
struct Count {
  std::size_t total = 0;
  readback::OperationMoves operation;
};

Result<Count> count_moves(std::string_view text, const std::string& file, const readback::NcControl& control,
                          int operation) {
  Count c;
  const auto sink = [&](const readback::ExecutedMove& m) {
    ++c.total;
    if (m.operation == operation) c.operation.add(m);
  };
  if (auto s = readback::execute_nc(text, file, control, sink); !s) return s.error();
  return c;
}

class RestartComparison {
 public:
  RestartComparison(const std::string& file, const readback::NcControl& control, const RestartPlace& from)
      : file_(file), control_(control), from_(from) {
    proof_.least.fill(std::numeric_limits<double>::infinity());
    proof_.greatest.fill(-std::numeric_limits<double>::infinity());
  }

  Result<RestartProof> run(std::string_view whole, std::string_view restart) {
    const auto all = count_moves(whole, file_, control_, from_.operation);
    if (!all) return all.error();
    const auto part = count_moves(restart, file_, control_, from_.operation);
    if (!part) return part.error();
    if (!same_numbers(*all, *part)) return std::move(proof_);
    const std::size_t lead = part->operation.lead(), tail = part->total - lead;
    if (auto s = keep_tail(whole, all->total - tail, tail); !s) return s.error();
    if (auto s = compare(restart, lead); !s) return s.error();
    proof_.same = proof_.difference.empty();
    return std::move(proof_);
  }

 private:
  void differs(int line, int whole_line, std::string what) {
    if (!proof_.difference.empty()) return;
    proof_.line = line;
    proof_.whole_line = whole_line;
    proof_.difference = std::move(what);
  }

  /// Where no comment names the teeth their number of moves does.
  bool same_numbers(const Count& all, const Count& part) {
    const auto z = static_cast<std::size_t>(from_.teeth), left = static_cast<std::size_t>(from_.teeth - from_.place);
    const readback::OperationMoves &in_all = all.operation, &in_part = part.operation;
    if (!in_all.labelled && in_part.teeth() * z != in_all.teeth() * left)
      differs(
          0, 0,
          fmt::format("operation {} has {} moves from tooth {} on, not {} of {} teeth of the {} of the whole program",
                      from_.operation, in_part.teeth(), from_.tooth, left, from_.teeth, in_all.teeth()));
    if (part.total - in_part.lead() > all.total) differs(0, 0, "the restart has more moves than the whole program");
    return proof_.difference.empty();
  }

  /// What the whole program does behind its first `ahead` moves.
  Status keep_tail(std::string_view whole, std::size_t ahead, std::size_t tail) {
    kept_.reserve(tail);
    std::size_t i = 0;
    Fingerprint print(control_);
    readback::ExecutedMove before;
    return readback::execute_nc(whole, file_, control_, [&](const readback::ExecutedMove& m) {
      if (i++ < ahead) {
        before = m;
        return;
      }
      if (kept_.empty() && m.tooth >= 0 && before.operation == from_.operation && before.tooth == m.tooth &&
          !before.machine)
        differs(0, m.line, "the restart begins inside a tooth");
      if (kept_.empty() && (m.operation != from_.operation || (m.tooth >= 0 && m.tooth != from_.tooth)))
        differs(0, m.line, fmt::format("the whole program is at operation {} tooth {} there", m.operation, m.tooth));
      kept_.push_back({print.of(m), m.line});
    });
  }

  void reach(const std::array<double, 5>& joints) {
    for (std::size_t a = 0; a < 5; ++a) {  // NaN (not yet known) passes neither comparison
      if (joints[a] < proof_.least[a]) proof_.least[a] = joints[a];
      if (joints[a] > proof_.greatest[a]) proof_.greatest[a] = joints[a];
    }
  }

  /// The restart against what was kept; its first `lead` moves are its own.
  Status compare(std::string_view restart, std::size_t lead) {
    std::size_t i = 0;
    Fingerprint own(control_);
    bool cut = false;
    readback::ExecutedMove last;
    auto s = readback::execute_nc(restart, file_, control_, [&](const readback::ExecutedMove& m) {
      reach(m.joints);
      if (m.tcp && m.known && control_.chain)
        readback::follow_tip(last, m, control_, *control_.chain,
                             [this](const std::array<double, 5>& joints) { reach(joints); });
      last = m;
      if (!cut) proof_.approach.moves.push_back(m);
      cut = cut || !m.rapid;
      const std::size_t n = i++;
      if (n < lead) {
        if (!m.machine) differs(m.line, 0, "a move ahead of the first tooth is no machine move");
        return;
      }
      const Kept& k = kept_[n - lead];
      if (own.of(m) != k.print) differs(m.line, k.line, "another move than in the whole program");
      if (!m.rapid && !own.all_set(control_)) differs(m.line, k.line, "a cut before every axis has had its word");
      proof_.line_of.emplace(k.line, m.line);
    });
    proof_.moves = i - lead;
    auto& approach = proof_.approach;
    approach.operation = from_.operation;
    approach.lead = lead;
    approach.tool = approach.moves.empty() ? 0 : approach.moves.back().tool;
    approach.kept_teeth = 1;
    return s;
  }

  const std::string& file_;
  const readback::NcControl& control_;
  const RestartPlace& from_;
  RestartProof proof_;
  std::vector<Kept> kept_;  ///< of the whole program, from the restart's first tooth on
};

}  // namespace

Result<RestartProof> prove_restart(std::string_view whole, std::string_view restart, const std::string& file,
                                   const readback::NcControl& control, const RestartPlace& from) {
  return RestartComparison(file, control, from).run(whole, restart);
}

}  // namespace toothpath::restart
