#include "machines/body_file.h"

#include <algorithm>
#include <filesystem>

#include "machines/links.h"
#include "machines/machine_table.h"
#include "machines/toml/near_name.h"

namespace toothpath::machines {
namespace {

constexpr double kLeastSize = 0.01;  // mm, of an edge or a radius: less is no body

std::optional<BoxShape> read_box(toml::TableReader& body) {
  const auto low = read_vector(body, "min", kLargestLength, " mm"),
             high = read_vector(body, "max", kLargestLength, " mm");
  if (!low || !high) return std::nullopt;
  for (int k = 0; k < 3; ++k)
    if ((*high)[k] - (*low)[k] < kLeastSize) {
      body.refuse("max", "{}[{}] = {} must exceed {}[{}] = {} by {} mm or more: the box is empty", body.name("max"), k,
                  (*high)[k], body.name("min"), k, (*low)[k], kLeastSize);
      return std::nullopt;
    }
  return BoxShape{*low, *high};
}

std::optional<ConeShape> read_round(toml::TableReader& body, bool cone) {
  const auto from = read_vector(body, "from", kLargestLength, " mm"),
             to = read_vector(body, "to", kLargestLength, " mm");
  const toml::Range most = {0.0, kLargestLength, " mm"};
  const auto first = body.number("diameter", cone ? most : toml::Range::positive(kLargestLength, " mm"));
  const auto second = cone ? body.number("diameter_to", most) : first;
  if (!from || !to || !first || !second) return std::nullopt;
  if ((*to - *from).norm() < kLeastSize) {
    body.refuse("to", "{} is {:.6g} mm from {}, must be {} mm or more: the body is empty", body.name("to"),
                (*to - *from).norm(), body.name("from"), kLeastSize);
    return std::nullopt;
  }
  if (std::max(*first, *second) < 2 * kLeastSize) {
    body.refuse("diameter", "{} = {} mm is below {} mm: the body is empty", body.name("diameter"), *first,
                2 * kLeastSize);
    return std::nullopt;
  }
  return ConeShape{*from, *to, *first / 2, *second / 2};
}

std::optional<MeshShape> read_mesh(toml::TableReader& body, const std::string& machine_file) {
  const auto file = body.text("file");
  if (!file) return std::nullopt;
  const std::filesystem::path path = *file;
  if (path.is_absolute()) return MeshShape{path.string()};
  return MeshShape{(std::filesystem::path(machine_file).parent_path() / path).lexically_normal().string()};
}

void read_shape(toml::TableReader& table, const std::string& machine_file, MachineBody& body) {
  const auto shape = table.variant("shape", {"box", "cylinder", "cone", "mesh"});
  if (!shape) return;
  if (*shape == "box") {
    if (const auto box = read_box(table)) body.shape = *box;
  } else if (*shape == "mesh") {
    if (auto mesh = read_mesh(table, machine_file)) body.shape = std::move(*mesh);
  } else if (const auto round = read_round(table, *shape == "cone")) {
    body.shape = *round;
  }
}

/// Every name stands once, and `touches` names others.
void check_names(std::vector<toml::TableReader>& tables, const std::vector<MachineBody>& bodies) {
  std::vector<std::string> names;
  for (const MachineBody& body : bodies) names.push_back(body.name);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const auto same = [&](const std::string& name) { return name == names[k]; };
    if (!names[k].empty() && std::any_of(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), same))
      tables[k].refuse("name", "{} = \"{}\" is the name of another body", tables[k].name("name"), names[k]);
    for (const std::string& other : bodies[k].touches) {
      if (other == names[k])
        tables[k].refuse("touches", "{} names the body itself, \"{}\"", tables[k].name("touches"), other);
      else if (std::find(names.begin(), names.end(), other) == names.end())
        tables[k].refuse("touches", "{} names \"{}\", which is no body of this machine{}", tables[k].name("touches"),
                         other, toml::did_you_mean(other, names));
    }
  }
}

}  // namespace

void read_bodies(toml::TableReader& root, Machine& machine) {
  auto tables = root.tables("body");
  if (tables.size() > kMostBodies) {
    root.refuse("body", "the machine has {} bodies, allowed are {}", tables.size(), kMostBodies);
    return;
  }
  const Links links(machine.chain);
  for (toml::TableReader& table : tables) {
    MachineBody body;
    body.key = table.path();
    body.name = table.text("name", {.ascii = true}).value_or("");
    if (const auto of = table.text("of")) {
      const auto link = links.find(*of);
      if (!link)
        table.refuse("of", "{} = \"{}\" is no link of this machine, which has {}", table.name("of"), *of,
                     fmt::join(links.names(), ", "));
      body.link = link.value_or(0);
    }
    read_shape(table, machine.file, body);
    body.touches = table.optional_ascii_list("touches").value_or(std::vector<std::string>{});
    table.finish();
    machine.bodies.push_back(std::move(body));
  }
  check_names(tables, machine.bodies);
}

void read_chain_order(toml::TableReader& chain_table, KinematicChain& chain) {
  const bool whole = chain_table.errors() == 0;  // else the axes are not all there
  const auto names = chain_table.optional_ascii_list("order");
  if (!names || !whole) return;
  std::string order;
  for (const std::string& name : *names) {
    const bool axis = name.size() == 1 && (chain.rotary_index(name.front()) || (name[0] >= 'X' && name[0] <= 'Z'));
    if (!axis && name != "bed") {
      chain_table.refuse("order", "{} names \"{}\", which is neither an axis of the chain nor \"bed\"",
                         chain_table.name("order"), name);
      return;
    }
    order += name == "bed" ? kBedMark : name.front();
  }
  // What the chain says already: the table's rotaries come first, the head's last.
  std::string wanted = chain.letters() + kBedMark, found = order, table, head;
  std::sort(found.begin(), found.end());
  std::sort(wanted.begin(), wanted.end());
  for (const RotaryAxis& axis : chain.table) table += axis.letter;
  for (const RotaryAxis& axis : chain.head) head += axis.letter;
  const std::size_t bed = std::min(order.find(kBedMark), order.size());
  const bool sides = bed >= table.size() && order.size() - bed > head.size();
  if (found != wanted || !order.starts_with(table) || !order.ends_with(head) || !sides) {
    chain_table.refuse("order",
                       "{} must name \"bed\" and every axis once: the rotaries of chain.table first, those of "
                       "chain.head last",
                       chain_table.name("order"));
    return;
  }
  chain.order = order;
}

}  // namespace toothpath::machines
