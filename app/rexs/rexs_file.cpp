#include "app/rexs/rexs_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <pugixml.hpp>
#include <sstream>

#include "geometry/base/printable.h"
#include "machines/toml/input_text.h"

namespace toothpath::rexs {
namespace {

constexpr std::size_t kMostBytes = 256u << 20;
constexpr std::array<std::string_view, 4> kVersions = {"1.4", "1.5", "1.6", "1.7"};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// From the nodes of one document to ours.
class Reading {
 public:
  Reading(std::string_view text, const std::string& file) : text_(text), file_(file) {
    for (std::size_t k = 0; k < text.size(); ++k)
      if (text[k] == '\n') ends_.push_back(k);
  }

  Result<RexsFile> run() {
    if (text_.starts_with("PK"))
      return fail_at({file_, 1, 1}, "this is a zipped REXS file: unpack it, and give the .rexs inside");
    if (trimmed(text_).starts_with("{"))
      return fail_at({file_, 1, 1}, "this is a REXS file in JSON: only those in XML are read");
    pugi::xml_document document;
    const auto parsed = document.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed)
      return fail_at(place(std::size_t(std::max<std::ptrdiff_t>(parsed.offset, 0))), "no XML: {}",
                     parsed.description());
    const pugi::xml_node model = document.child("model");
    if (!model) return fail_at({file_, 1, 1}, "no REXS: its first element is not <model>");
    out_.file = file_;
    out_.version = model.attribute("version").value();
    if (std::find(kVersions.begin(), kVersions.end(), out_.version) == kVersions.end())
      return fail_at(place(model), "REXS version \"{}\": 1.4 to 1.7 are read", printable(out_.version));
    for (const pugi::xml_node node : model.child("components").children("component"))
      if (auto done = take_component(node); !done) return done.error();
    for (const pugi::xml_node node : model.child("relations").children("relation"))
      if (auto done = take_relation(node); !done) return done.error();
    return std::move(out_);
  }

 private:
  [[nodiscard]] SourcePosition place(std::size_t offset) const {
    const auto line = std::lower_bound(ends_.begin(), ends_.end(), offset) - ends_.begin();
    const std::size_t begin = line == 0 ? 0 : ends_[std::size_t(line) - 1] + 1;
    return {file_, int(line) + 1, int(offset - begin) + 1};
  }
  [[nodiscard]] SourcePosition place(const pugi::xml_node& node) const {
    const std::ptrdiff_t offset = node.offset_debug();  // of its name, behind the bracket
    return place(offset > 0 ? std::size_t(offset) - 1 : 0);
  }

  Result<int> number_of(const pugi::xml_node& node) const {
    const std::string_view text = node.attribute("id").value();
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty())
      return fail_at(place(node), "id = \"{}\" of <{}> is no whole number", printable(text), printable(node.name()));
    return value;
  }

  Status take_component(const pugi::xml_node& node) {
    const auto id = number_of(node);
    if (!id) return id.error();
    if (std::binary_search(index_.begin(), index_.end(), *id))
      return fail_at(place(node), "component {} stands in line {} already", *id, out_.find(*id)->at.line);
    Component component{*id, node.attribute("type").value(), node.attribute("name").value(), {}, place(node)};
    for (const pugi::xml_node one : node.children("attribute")) {
      const pugi::xml_attribute unit = one.attribute("unit");
      Attribute a{one.attribute("id").value(),
                  unit.value(),
                  std::string(trimmed(one.child_value())),
                  !unit.empty(),
                  !one.child("array").attribute("code").empty(),
                  {},
                  place(one)};
      for (const pugi::xml_node cell : one.child("array").children("c"))
        a.cells.emplace_back(trimmed(cell.child_value()));
      if (const Attribute* other = component.find(a.id))
        return fail_at(a.at, "{} of {} stands in line {} already", printable(a.id), component.title(), other->at.line);
      component.attributes.push_back(std::move(a));
    }
    index_.insert(std::upper_bound(index_.begin(), index_.end(), *id), *id);
    out_.components.push_back(std::move(component));
    return Ok{};
  }

  Status take_relation(const pugi::xml_node& node) {
    Relation relation{node.attribute("type").value(), node.attribute("order").as_int(), {}, place(node)};
    for (const pugi::xml_node one : node.children("ref")) {
      const auto id = number_of(one);
      if (!id) return id.error();
      if (!std::binary_search(index_.begin(), index_.end(), *id))
        return fail_at(place(one), "there is no component {} in this file", *id);
      relation.refs.push_back({*id, one.attribute("role").value(), place(one)});
    }
    out_.relations.push_back(std::move(relation));
    return Ok{};
  }

  std::string_view text_;
  const std::string& file_;
  std::vector<std::size_t> ends_;  ///< of lines
  std::vector<int> index_;         ///< numbers of components, rising
  RexsFile out_;
};

}  // namespace

const Attribute* Component::find(std::string_view attribute) const {
  const auto found =
      std::find_if(attributes.begin(), attributes.end(), [&](const Attribute& a) { return a.id == attribute; });
  return found == attributes.end() ? nullptr : &*found;
}

std::string Component::title() const {
  return printable(name.empty() ? fmt::format("{} {}", type, id) : fmt::format("{} {} ({})", type, id, name));
}

const Reference* Relation::role(std::string_view name) const {
  const auto found = std::find_if(refs.begin(), refs.end(), [&](const Reference& r) { return r.role == name; });
  return found == refs.end() ? nullptr : &*found;
}

const Component* RexsFile::find(int id) const {
  const auto found = std::find_if(components.begin(), components.end(), [&](const Component& c) { return c.id == id; });
  return found == components.end() ? nullptr : &*found;
}

std::string rexs_text(const RexsFile& file) {
  pugi::xml_document document;
  pugi::xml_node head = document.append_child(pugi::node_declaration);
  head.append_attribute("version") = "1.0";
  head.append_attribute("encoding") = "UTF-8";
  pugi::xml_node model = document.append_child("model");
  model.append_attribute("version") = "1.7";
  model.append_attribute("applicationId") = "Toothpath";
  pugi::xml_node relations = model.append_child("relations"), components = model.append_child("components");
  int number = 0;
  for (const Relation& relation : file.relations) {
    pugi::xml_node node = relations.append_child("relation");
    node.append_attribute("id") = ++number;
    node.append_attribute("type") = relation.type.c_str();
    if (relation.order > 0) node.append_attribute("order") = relation.order;
    for (const Reference& ref : relation.refs) {
      pugi::xml_node one = node.append_child("ref");
      one.append_attribute("id") = ref.id;
      one.append_attribute("role") = ref.role.c_str();
      one.append_attribute("hint") = file.find(ref.id)->type.c_str();
    }
  }
  for (const Component& component : file.components) {
    pugi::xml_node node = components.append_child("component");
    node.append_attribute("id") = component.id;
    node.append_attribute("type") = component.type.c_str();
    node.append_attribute("name") = component.name.c_str();
    for (const Attribute& attribute : component.attributes) {
      pugi::xml_node one = node.append_child("attribute");
      one.append_attribute("id") = attribute.id.c_str();
      one.append_attribute("unit") = attribute.unit.c_str();
      if (attribute.cells.empty()) one.append_child(pugi::node_pcdata).set_value(attribute.text.c_str());
      else
        for (pugi::xml_node list = one.append_child("array"); const std::string& cell : attribute.cells)
          list.append_child("c").append_child(pugi::node_pcdata).set_value(cell.c_str());
    }
  }
  std::ostringstream out;
  document.save(out, "  ", pugi::format_indent, pugi::encoding_utf8);
  return out.str();
}

Result<RexsFile> parse_rexs(std::string_view text, const std::string& file) { return Reading(text, file).run(); }

Result<RexsFile> read_rexs(const std::string& file) {
  const auto text = toml::read_input_text(file, kMostBytes);
  if (!text) return text.error();
  return parse_rexs(*text, file);
}

}  // namespace toothpath::rexs
