// A REXS file as text: components with attributes, and what relates them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath::rexs {

struct Attribute {
  std::string id, unit, text;
  bool states_unit = false;
  bool coded = false;              ///< an array in Base64
  std::vector<std::string> cells;  ///< of an array
  SourcePosition at;
};

struct Component {
  int id = 0;
  std::string type, name;
  std::vector<Attribute> attributes;
  SourcePosition at;
  /// Null: it has none.
  [[nodiscard]] const Attribute* find(std::string_view attribute) const;
  /// "bevel_gear 3 (Pinion)".
  [[nodiscard]] std::string title() const;
};

struct Reference {
  int id = 0;
  std::string role;
  SourcePosition at;
};
struct Relation {
  std::string type;
  int order = 0;
  std::vector<Reference> refs;
  SourcePosition at;
  /// Null: nothing has this role.
  [[nodiscard]] const Reference* role(std::string_view name) const;
};

struct RexsFile {
  std::string file, version;
  std::vector<Component> components;
  std::vector<Relation> relations;
  [[nodiscard]] const Component* find(int id) const;
};

/// The file as XML. Refused, with line and column: what is no XML or no REXS, zipped files and those in JSON, other
/// versions than 1.4 to 1.7, numbers of components that are none or stand there twice, references to none.
[[nodiscard]] Result<RexsFile> parse_rexs(std::string_view text, const std::string& file);
[[nodiscard]] Result<RexsFile> read_rexs(const std::string& file);

/// The same as XML, of version 1.7. The same components, the same bytes: there is no date.
[[nodiscard]] std::string rexs_text(const RexsFile& file);

}  // namespace toothpath::rexs
