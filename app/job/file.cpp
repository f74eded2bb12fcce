#include "app/job/file.h"

#include <algorithm>
#include <filesystem>

#include "app/job/tables.h"
#include "app/job/words.h"
#include "machines/toml/regular_file.h"

namespace toothpath::job {
namespace {

/// Sisters are tools of their own: the same form, another number. They stand behind all tools that the job names.
void add_sisters(std::vector<toml::TableReader>& tables, Job& job) {
  for (std::size_t k = 0; k < tables.size(); ++k)
    for (std::size_t i = 0; i < job.tools[k].sisters.size(); ++i) {
      const int number = job.tools[k].sisters[i];
      const auto same = [&](const tool::ToolAssembly& other) { return other.number == number; };
      if (const auto there = std::find_if(job.tools.begin(), job.tools.end(), same); there != job.tools.end()) {
        tables[k].refuse_at(tables[k].where("sisters", i), "sisters: tool {} is {}", number,
                            there->sister_of != 0 ? fmt::format("a sister of tool {} already", there->sister_of)
                                                  : std::string("a [[tool]] of its own"));
        continue;
      }
      tool::ToolAssembly sister = job.tools[k];
      sister.number = number;
      sister.sister_of = job.tools[k].number;
      sister.sisters.clear();
      job.tools.push_back(std::move(sister));
    }
}

void read_tools(toml::TableReader& root, Job& job) {
  const ToolContext context{job.bevel_gear(), job.directory()};
  auto tables = root.tables("tool", {1, SIZE_MAX});
  for (auto& table : tables) {
    tool::ToolAssembly tool = read_tool(table, context, job.warnings);
    const auto same = [&](const tool::ToolAssembly& other) { return other.number == tool.number && tool.number > 0; };
    if (std::any_of(job.tools.begin(), job.tools.end(), same))
      table.refuse("number", "number = {} is used by two tools", tool.number);
    job.tools.push_back(std::move(tool));
  }
  add_sisters(tables, job);
}

constexpr std::pair<const char*, const char*> kMillingTables[] = {
    {"machine", "[machine]"}, {"setup", "[setup]"}, {"tool", "[[tool]]"}};
constexpr std::size_t kMostOperations = 100;

/// The tables that milling needs when there is something to mill.
void check_milling(toml::TableReader& root, const Job& job) {
  if (job.operations.empty()) return;
  for (const auto& [key, title] : kMillingTables)
    if (!root.has(key)) root.refuse(key, "the job has operations but lacks the table {}", title);
}

/// The whole file.
void read_job(toml::TableReader& root, Job& job) {
  (void)root.integer("schema", {1, 1});
  job.name = root.text("name").value_or("");
  read_gear(root, job);
  if (auto table = root.table("machine")) job.machine = read_machine_choice(*table);
  if (auto table = root.table("setup")) job.setup = read_setup(*table, job);
  if (auto table = root.table("shaping")) job.shaping = read_shaping(*table);
  if (auto table = root.table("contact")) job.contact = read_contact(*table, job);
  if (auto table = root.table("coolant")) job.coolant = read_coolant(*table);
  if (auto table = root.table("material")) job.material = read_material(*table);
  if (auto table = root.table("verify")) job.verify = read_verify(*table);
  if (auto table = root.table("program")) job.program = read_program_settings(*table);
  if (auto table = root.table("load")) {
    job.torque_Nm = table->number("torque", kTorque);
    table->finish();
  }
  read_tools(root, job);
  auto operations = root.tables("operation", {0, kMostOperations});
  for (const auto& [key, title] : kMillingTables) root.relate(toml::KeyRelation::Kind::needs, "operation", key);
  if (operations.size() > kMostOperations)
    root.refuse("operation", "{} operations exceed the limit {}", operations.size(), kMostOperations);
  for (auto& table : operations)
    job.operations.push_back(
        read_operation(table, {job.tools, job.bevel_gear() != nullptr, job.face_gear() != nullptr}));
  check_milling(root, job);
  if (root.errors() == 0) check_mills(root, job);
  root.finish();
}

}  // namespace

SourcePosition Job::where(std::string_view key) const {
  std::string path(key);
  while (true) {
    if (const auto found = positions.find(path); found != positions.end()) return found->second;
    const auto cut = path.find_last_of(".[");
    if (path.empty()) return {file, 0, 0};
    path.resize(cut == std::string::npos ? 0 : cut);
  }
}

std::vector<Diagnostic> note_job_keys(const toml::TomlValue& document, const std::string& file, toml::KeyNotes& notes) {
  Job job;
  job.file = file;
  toml::ReaderFindings findings(job_words());
  findings.notes = &notes;
  toml::TableReader root(document, "", findings);
  read_job(root, job);
  return std::move(findings.errors);
}

JobOrErrors parse_job(std::string_view text, const std::string& file) {
  const auto document = toml::parse_toml(text, file, kJobSyntax);
  if (!document) return std::vector<Diagnostic>{document.error()};

  Job job;
  job.file = file;
  toml::ReaderFindings findings(job_words());
  toml::TableReader root(*document, "", findings);
  read_job(root, job);
  if (!findings.errors.empty()) {
    toml::sort_by_position(findings.errors);
    return std::move(findings.errors);
  }
  job.positions = std::move(findings.positions);
  return job;
}

JobOrErrors read_job_file(const std::string& path) {
  const auto text = toml::read_input_file(path, kMaxJobBytes);
  if (!text) return std::vector<Diagnostic>{text.error()};
  return parse_job(*text, path);
}

}  // namespace toothpath::job
