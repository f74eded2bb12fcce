#include "geometry/mesh/obj_scan.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace toothpath::mesh {
namespace {

constexpr std::size_t kMostVertices = std::size_t(1) << 30;
/// What stands in a mesh and does not change its shape.
constexpr std::string_view kPassedOver[] = {"vn",     "vt",    "vp",       "o",        "g",      "s",
                                            "mg",     "l",     "p",        "usemtl",   "mtllib", "usemap",
                                            "maplib", "bevel", "c_interp", "d_interp", "lod"};

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The next word of the line; empty: none.
std::string_view next_word(std::string_view& line) {
  while (!line.empty() && blank(line.front())) line.remove_prefix(1);
  const auto end = std::find_if(line.begin(), line.end(), blank);
  const std::string_view word = line.substr(0, static_cast<std::size_t>(end - line.begin()));
  line.remove_prefix(word.size());
  return word;
}

class ObjReading {
 public:
  ObjReading(const std::string& name, std::size_t most_facets) : name_(name), most_facets_(most_facets) {}

  Result<ObjScan> run(std::string_view text) {
    while (!text.empty()) {
      ++line_;
      const auto end = text.find('\n');
      if (auto s = take(text.substr(0, end)); !s) return s.error();
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return std::move(scan_);
  }

 private:
  [[nodiscard]] SourcePosition here() const { return {name_, line_, 0}; }

  Status take(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword.empty() || keyword.front() == '#') return Ok{};
    if (keyword == "v") return vertex(line);
    if (keyword == "f") return facet(line);
    if (std::find(std::begin(kPassedOver), std::end(kPassedOver), keyword) != std::end(kPassedOver)) return Ok{};
    return fail_at(here(), "\"{}\" begins no line of a mesh in OBJ", keyword.substr(0, 40));
  }

  /// X Y Z, then perhaps a weight of 1 or a colour.
  Status vertex(std::string_view line) {
    std::array<double, 7> values{};
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      if (count == values.size()) return fail_at(here(), "the vertex has more than {} numbers", values.size());
      std::string_view digits = word;
      if (digits.front() == '+') digits.remove_prefix(1);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), values[count]);
      if (error != std::errc{} || end != digits.data() + digits.size() ||
          !(std::abs(values[count]) <= std::numeric_limits<float>::max()))
        return fail_at(here(), "\"{}\" is no finite number of 32 bits", word.substr(0, 40));
      ++count;
    }
    if (count < 3 || count == 5) return fail_at(here(), "the vertex has {} numbers, must have 3", count);
    if (count == 4 && values[3] != 1) return fail_at(here(), "the vertex has the weight {}, must be 1", values[3]);
    if (scan_.vertices.size() >= kMostVertices) return fail_at(here(), "more than {} vertices", kMostVertices);
    scan_.vertices.push_back(
        {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])});
    return Ok{};
  }

  /// Three corners, each V, V/T, V//N or V/T/N; negative ones count back from the last vertex.
  Status facet(std::string_view line) {
    std::array<std::int32_t, 3> corners{};
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
      if (count >= corners.size()) continue;
      const std::string_view number = word.substr(0, word.find('/'));
      std::int64_t index = 0;
      const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
      const auto vertices = static_cast<std::int64_t>(scan_.vertices.size());
      if (error != std::errc{} || end != number.data() + number.size() || index == 0)
        return fail_at(here(), "\"{}\" names no vertex", word.substr(0, 40));
      if (index > vertices || index < -vertices)
        return fail_at(here(), "the facet names vertex {} of the {} above it", index, vertices);
      corners[count] = static_cast<std::int32_t>(index > 0 ? index - 1 : vertices + index);
    }
    if (count != corners.size())
      return fail_at(here(), "facet {} has {} corners; only triangles are read", scan_.facets.size(), count);
    if (scan_.facets.size() >= most_facets_)
      return fail_at(here(), "the file has more than {} facets, the limit", most_facets_);
    scan_.facets.push_back(corners);
    return Ok{};
  }

  const std::string& name_;
  std::size_t most_facets_;
  int line_ = 0;
  ObjScan scan_;
};

}  // namespace

Result<ObjScan> scan_obj(std::string_view text, const std::string& name, std::size_t most_facets) {
  return ObjReading(name, most_facets).run(text);
}

}  // namespace toothpath::mesh
