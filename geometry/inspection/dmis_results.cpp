#include <algorithm>
#include <array>

#include "geometry/base/angle.h"
#include "geometry/inspection/point_file.h"
#include "geometry/inspection/point_words.h"

namespace toothpath::inspection {
namespace {

/// One statement: its lines joined, and where each of them stands.
struct Statement {
  struct Piece {
    std::size_t from;  ///< in the text
    int line;
  };
  std::string text;
  std::vector<Piece> pieces;

  [[nodiscard]] SourcePosition at(std::size_t offset, const std::string& file) const {
    const Piece* piece = &pieces.front();
    for (const Piece& p : pieces)
      if (p.from <= offset) piece = &p;
    return {file, piece->line, int(offset - piece->from) + 1};
  }
};

/// Statements in their order, comments left out.
class Statements {
 public:
  explicit Statements(std::string_view text) : left_(text) {
    if (left_.starts_with("\xef\xbb\xbf")) left_.remove_prefix(3);
  }
  [[nodiscard]] int line() const { return line_; }
  bool next(Statement& out) {
    out.text.clear();
    out.pieces.clear();
    bool more = false;
    while (!left_.empty()) {
      const auto end = left_.find('\n');
      std::string_view row = left_.substr(0, end);
      left_.remove_prefix(end == std::string_view::npos ? left_.size() : end + 1);
      ++line_;
      while (!row.empty() && (row.back() == '\r' || row.back() == ' ' || row.back() == '\t')) row.remove_suffix(1);
      if (trimmed(row).starts_with("$$")) continue;
      if (const auto comment = row.find("$$"); comment != std::string_view::npos) row = row.substr(0, comment);
      more = row.ends_with('$');
      if (more) row.remove_suffix(1);
      if (!more && out.pieces.empty() && trimmed(row).empty()) continue;
      out.pieces.push_back({out.text.size(), line_});
      out.text += row;
      if (!more) return true;
    }
    return !out.pieces.empty();
  }

 private:
  std::string_view left_;
  int line_ = 0;
};

/// A field of a statement, and where it begins in it.
struct Field {
  std::string_view text;
  std::size_t from = 0;
};

std::vector<Field> fields_of(std::string_view text, std::size_t from) {
  std::vector<Field> fields;
  while (true) {
    const auto comma = std::min(text.find(',', from), text.size());
    std::string_view field = text.substr(from, comma - from);
    std::size_t begin = from;
    while (!field.empty() && (field.front() == ' ' || field.front() == '\t')) {
      field.remove_prefix(1);
      ++begin;
    }
    fields.push_back({trimmed(field), begin});
    if (comma >= text.size()) return fields;
    from = comma + 1;
  }
}

class ResultReader {
 public:
  explicit ResultReader(const std::string& file) : file_(file) {}

  Status take(const Statement& statement) {
    const std::string_view text = statement.text;
    std::size_t from = 0;
    while (from < text.size() && (text[from] == ' ' || text[from] == '\t')) ++from;
    const std::string head = upper(text.substr(from, 64));
    if (head.starts_with("UNITS/")) return take_units(fields_of(text, from + 6), statement);
    if (head.starts_with("PTDATA/")) {
      if (!raw_) return Ok{};
      return take_point(fields_of(text, from + 7), 0, statement, "PTDATA");
    }
    if (!head.starts_with("FA(")) return Ok{};
    const auto close = text.find(')', from), equals = text.find('=', std::min(close, text.size()));
    if (close == std::string_view::npos || equals == std::string_view::npos ||
        !trimmed(text.substr(close + 1, equals - close - 1)).empty())
      return fail_at(statement.at(from, file_), "FA(..) lacks \"=FEAT/..\" behind its label");
    label_ = std::string(trimmed(text.substr(from + 3, close - from - 3)));
    const auto fields = fields_of(text, equals + 1);
    const std::string kind = upper(fields.front().text);
    raw_ = kind.starts_with("FEAT/") && kind != "FEAT/POINT";
    out_.other_features += raw_;
    if (kind == "FEAT/POINT") return take_point(fields, 1, statement, "FEAT/POINT");
    if (!raw_)
      return fail_at(statement.at(fields.front().from, file_), "FA({}) is \"{}\", must be FEAT/..", label_,
                     fields.front().text);
    return Ok{};
  }
  [[nodiscard]] PointFile result() && { return std::move(out_); }
  [[nodiscard]] const PointFile& found() const { return out_; }

 private:
  Status take_units(const std::vector<Field>& fields, const Statement& statement) {
    struct Unit {
      const char* name;
      double mm;
    };
    for (const Unit unit : {Unit{"MM", 1}, Unit{"CM", 10}, Unit{"M", 1000}, Unit{"INCH", 25.4}, Unit{"FEET", 304.8}})
      if (upper(fields[0].text) == unit.name) {
        mm_ = unit.mm;
        out_.unit_mm = unit.mm;
        degrees_ = true;
        other_angle_.clear();
        for (std::size_t k = 1; k < fields.size(); ++k) {
          const std::string word = upper(fields[k].text);
          if (word == "ANGRAD") degrees_ = false;
          else if (word != "ANGDEC" && word.starts_with("ANG")) other_angle_ = word;
        }
        return Ok{};
      }
    return fail_at(statement.at(fields[0].from, file_), "UNITS/{} is none of MM, CM, M, INCH, FEET", fields[0].text);
  }

  Status take_point(const std::vector<Field>& fields, std::size_t first, const Statement& statement, const char* what) {
    if (out_.points.size() == kMostPoints) return too_many_points(statement.at(0, file_));
    const std::string_view frame = first < fields.size() ? fields[first].text : std::string_view();
    const bool polar = upper(frame) == "POL";
    if (!polar && upper(frame) != "CART")
      return fail_at(statement.at(fields[std::min(first, fields.size() - 1)].from, file_),
                     "{} of {} is in \"{}\", must be CART or POL", what, label_, frame);
    const std::size_t values = fields.size() - first - 1;
    if (values != 6 && (values != 3 || !raw_))
      return fail_at(statement.at(fields[first].from, file_), "{} of {} has {} values, must be 6: x,y,z,i,j,k", what,
                     label_, values);
    if (polar && !other_angle_.empty())
      return fail_at(statement.at(fields[first].from, file_),
                     "{} of {} is polar in {}: angles must be ANGDEC or ANGRAD", what, label_, other_angle_);
    std::array<double, 6> value{};
    for (std::size_t k = 0; k < values; ++k) {
      const Field& field = fields[first + 1 + k];
      if (!read_number(field.text, value[k]))
        return fail_at(statement.at(field.from, file_), "{} of {}: \"{}\" is no finite number", what, label_,
                       field.text);
    }
    FilePoint point;
    point.at = statement.at(fields[first + 1].from, file_);
    point.label = label_;
    const double angle = degrees_ ? radians(value[1]) : value[1];
    point.p = mm_ * (polar ? Vec3(value[0] * std::cos(angle), value[0] * std::sin(angle), value[2])
                           : Vec3(value[0], value[1], value[2]));
    if (values == 6) {
      const auto n = read_normal({value[3], value[4], value[5]}, statement.at(fields[first + 4].from, file_));
      if (!n) return n.error();
      point.n = *n;
    }
    out_.points.push_back(std::move(point));
    return Ok{};
  }

  const std::string& file_;
  PointFile out_;
  std::string label_;
  double mm_ = 1;
  bool degrees_ = true;
  std::string other_angle_;
  bool raw_ = false;  ///< the last FA is no point: its raw points follow
};

}  // namespace

bool looks_like_dmis(std::string_view text) {
  Statements statements(text);
  Statement statement;
  while (statements.next(statement)) {
    const std::string head = upper(trimmed(std::string_view(statement.text)).substr(0, 8));
    for (const char* word : {"DMISMN/", "DMISMD/", "FA(", "F(", "UNITS/"})
      if (head.starts_with(word)) return true;
  }
  return false;
}

Result<PointFile> parse_dmis_results(std::string_view text, const std::string& file) {
  Statements statements(text);
  Statement statement;
  ResultReader reader(file);
  while (statements.next(statement))
    if (const auto taken = reader.take(statement); !taken) return taken.error();
  if (reader.found().points.empty())
    return fail_at({file, std::max(statements.line(), 1), 1},
                   "no measured point: statements FA(..)=FEAT/POINT,CART,x,y,z,i,j,k are needed{}",
                   reader.found().other_features ? fmt::format(" ({} other features)", reader.found().other_features)
                                                 : std::string());
  return std::move(reader).result();
}

}  // namespace toothpath::inspection
