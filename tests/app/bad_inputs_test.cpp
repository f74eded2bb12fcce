// The 99 bad inputs of tests/bad_inputs/items.toml: every item is held by something that exists, every case is run
// through the program, and docs/bad_inputs.md is the table made of them.
#include <charconv>
#include <cstdlib>
#include <set>

#include "machines/toml/toml_tree.h"
#include "tests/app/program.h"
#include "tests/machines/bad_machine_files.h"
#include "tests/machines/example_files.h"
#include "tests/support/test_names.h"

namespace toothpath::test {
namespace {

constexpr int kItems = 99;
const std::string kItemsFile = TOOTHPATH_SOURCE_DIR "/tests/bad_inputs/items.toml";
const std::string kPage = TOOTHPATH_SOURCE_DIR "/docs/bad_inputs.md";

struct InputCase {
  std::string of = "spur_quick.toml", make, name, text;
  std::vector<std::string> change, machine, says, unset, run = {"run", "{file}", "--out", "{out}"};
  bool has_text = false;
  int exit = -1;
};

struct Item {
  int number = 0;
  std::string input, open;
  std::vector<std::string> jobs, machines, tests;
  std::vector<InputCase> cases;
};

std::string text_of(const toml::TomlTable& table, const char* key) {
  const toml::TomlEntry* entry = table.find(key);
  return entry && entry->value.text() ? *entry->value.text() : "";
}

std::vector<std::string> list_of(const toml::TomlTable& table, const char* key) {
  std::vector<std::string> list;
  if (const toml::TomlEntry* entry = table.find(key); entry && entry->value.array())
    for (const auto& value : entry->value.array()->values) list.push_back(*value.text());
  return list;
}

int number_of(const toml::TomlTable& table, const char* key) {
  const toml::TomlEntry* entry = table.find(key);
  return entry && entry->value.number() ? int(*entry->value.number()) : -1;
}

InputCase case_of(const toml::TomlTable& table) {
  static const std::set<std::string> known = {"of",      "make", "name",  "text", "change",
                                              "machine", "says", "unset", "run",  "exit"};
  for (const auto& entry : table.entries) EXPECT_EQ(known.count(entry.key), 1u) << entry.key;
  InputCase c;
  if (table.find("of")) c.of = text_of(table, "of");
  c.make = text_of(table, "make");
  c.name = text_of(table, "name");
  c.text = text_of(table, "text");
  c.has_text = table.find("text") != nullptr;
  c.change = list_of(table, "change");
  c.machine = list_of(table, "machine");
  c.says = list_of(table, "says");
  c.unset = list_of(table, "unset");
  c.exit = number_of(table, "exit");
  if (!c.machine.empty()) c.run = {"machine", "show", "{file}"};
  if (table.find("run")) c.run = list_of(table, "run");
  return c;
}

std::vector<Item> read_items() {
  const auto tree = toml::parse_toml(file_text(kItemsFile), kItemsFile, {});
  std::vector<Item> items;
  if (!tree) {
    ADD_FAILURE() << tree.error().text();
    return items;
  }
  static const std::set<std::string> known = {"number", "input", "open", "jobs", "machines", "tests", "case"};
  for (const auto& value : tree->table()->find("item")->value.array()->values) {
    const toml::TomlTable& table = *value.table();
    for (const auto& entry : table.entries) EXPECT_EQ(known.count(entry.key), 1u) << entry.key;
    Item item{number_of(table, "number"),
              text_of(table, "input"),
              text_of(table, "open"),
              list_of(table, "jobs"),
              list_of(table, "machines"),
              list_of(table, "tests"),
              {}};
    if (const toml::TomlEntry* cases = table.find("case"))
      for (const auto& c : cases->value.array()->values) item.cases.push_back(case_of(*c.table()));
    items.push_back(std::move(item));
  }
  return items;
}

const std::vector<Item>& items() {
  static const std::vector<Item> all = read_items();
  return all;
}

/// \xNN as that byte.
std::string bytes_of(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    int byte = 0;
    if (text.compare(i, 2, "\\x") == 0 && i + 4 <= text.size() &&
        std::from_chars(text.data() + i + 2, text.data() + i + 4, byte, 16).ptr == text.data() + i + 4) {
      out += static_cast<char>(byte);
      i += 3;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string filled(std::string text, const std::string& name, const std::string& value) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + value.size()))
    text.replace(at, name.size(), value);
  return text;
}

/// The file of a case, and its name.
std::string file_for(const InputCase& c, const TestDir& dir) {
  const std::string file = dir / (c.name.empty() ? c.machine.empty() ? "job.toml" : "machine.toml" : bytes_of(c.name));
  if (c.make == "missing") return file;
  if (c.make == "directory") std::filesystem::create_directory(file);
  else if (c.make == "pipe") EXPECT_EQ(::mkfifo(file.c_str(), 0600), 0);
  else if (c.make == "loop") std::filesystem::create_symlink(file, file);
  else if (c.make == "endless") return "/dev/zero";
  else if (c.make == "unreadable") return "/proc/self/mem";  // nothing is mapped at its beginning
  else if (c.make == "large") write_file(file, std::string((1u << 20) + 1, '#'));
  else if (c.has_text) write_file(file, bytes_of(c.text));
  else if (!c.machine.empty()) write_file(file, replaced(kMachine, c.machine.at(0), bytes_of(c.machine.at(1))));
  else write_file(file, replaced(file_text(kSamples + "/" + c.of), c.change.at(0), bytes_of(c.change.at(1))));
  return file;
}

/// The environment without these names, for as long as it lives.
class Without {
 public:
  explicit Without(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      const char* value = std::getenv(name.c_str());
      if (value) kept_.emplace_back(name, value);
      ::unsetenv(name.c_str());
    }
  }
  ~Without() {
    for (const auto& [name, value] : kept_) ::setenv(name.c_str(), value.c_str(), 1);
  }
  Without(const Without&) = delete;
  Without& operator=(const Without&) = delete;

 private:
  std::vector<std::pair<std::string, std::string>> kept_;
};

bool has_control_characters(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f; });
}

void run_case(const InputCase& c) {
  const TestDir dir;
  const std::string file = file_for(c, dir);
  std::vector<std::string> words;
  for (const std::string& word : c.run)
    words.push_back(bytes_of(filled(filled(word, "{file}", file), "{out}", dir / "out")));
  const Finished run = [&] {
    const Without without(c.unset);
    return run_program(words);
  }();
  EXPECT_EQ(run.exit_code, c.exit) << run.err;
  for (const std::string& said : c.says)
    EXPECT_NE(run.err.find(filled(said, "{file}", file)), std::string::npos) << said << "\nin: " << run.err;
  EXPECT_FALSE(has_control_characters(run.err)) << run.err;
  if (c.exit != 0) { EXPECT_TRUE(names_in(dir / "out").empty()); }
}

class BadInput : public ::testing::TestWithParam<Item> {};

TEST_P(BadInput, IsHeld) {
  const Item& item = GetParam();
  EXPECT_FALSE(item.jobs.empty() && item.machines.empty() && item.tests.empty() && item.cases.empty() &&
               item.open.empty());
  for (const std::string& job : item.jobs) EXPECT_TRUE(std::filesystem::exists(kBadJobs + "/" + job + ".toml")) << job;
  for (const std::string& machine : item.machines)
    EXPECT_TRUE(std::any_of(std::begin(kBadMachineFiles), std::end(kBadMachineFiles), [&](const BadFile& bad) {
      return machine == bad.what;
    })) << machine;
  for (const InputCase& c : item.cases) run_case(c);
}

INSTANTIATE_TEST_SUITE_P(Items, BadInput, ::testing::ValuesIn(items()),
                         [](const auto& item) { return "Nr" + std::to_string(item.param.number); });

TEST(BadInputs, AreNumberedAndNameTestsThatExist) {
  const auto known = tests_in_sources();
  ASSERT_EQ(items().size(), std::size_t(kItems));
  for (int k = 0; k < kItems; ++k) {
    const Item& item = items()[std::size_t(k)];
    EXPECT_EQ(item.number, k + 1);
    for (const std::string& test : item.tests) EXPECT_EQ(known.count(test), 1u) << item.number << ": " << test;
  }
}

/// One cell of a Markdown table.
std::string cell(const std::string& text) { return filled(filled(text, "|", "\\|"), "\n", " "); }

std::string first_message(const std::string& job) {
  const std::string text = file_text(kBadJobs + "/" + job + ".toml");
  const std::string line = text.substr(0, text.find('\n'));
  const auto error = line.find("error: ");
  return error == std::string::npos ? line : line.substr(error + 7);
}

std::string machine_message(const std::string& name) {
  for (const BadFile& bad : kBadMachineFiles)
    if (name == bad.what) {
      const std::string messages = bad.messages;
      const auto error = messages.find("error: ");
      return messages.substr(error + 7, messages.find('\n') - error - 7);
    }
  return name;
}

std::string input_of(const InputCase& c) {
  if (!c.make.empty()) return c.make + (c.name.empty() ? "" : ", `" + cell(c.name) + "`");
  if (c.has_text) return c.text.empty() ? "no byte" : "`" + cell(c.text) + "`";
  return "`" + cell(c.machine.empty() ? c.change.at(1) : c.machine.at(1)) + "`";
}

std::string case_text(const InputCase& c) {
  std::string text = input_of(c) + ": " + std::to_string(c.exit);
  for (std::string said : c.says) {
    if (const auto error = said.find("error: "); said.starts_with("{file}") && error != std::string::npos)
      said = said.substr(error + 7);
    if (!said.empty() && said != "{file}:") text += ", `" + cell(said) + "`";
  }
  return text;
}

std::string page() {
  std::string out =
      "# Bad inputs\n\n"
      "What the program must survive, and what it says. Made of `tests/bad_inputs/items.toml` by a test; "
      "`TOOTHPATH_WRITE_GOLDEN=1` writes it anew.\n"
      "The number behind an input is the exit code. Files of `tests/bad_jobs` and spoilt machine files end with 3. "
      "Every message begins with the file's name, and line and column where there are any.\n\n"
      "| no. | input | what it says | held by |\n|---|---|---|---|\n";
  for (const Item& item : items()) {
    std::vector<std::string> said;
    for (const std::string& job : item.jobs) said.push_back("`" + cell(first_message(job)) + "`");
    for (const std::string& machine : item.machines) said.push_back("`" + cell(machine_message(machine)) + "`");
    for (const InputCase& c : item.cases) said.push_back(case_text(c));
    std::string held;
    if (!item.jobs.empty()) held = "`BadJob.IsRefusedWithItsFirstLine`";
    if (!item.machines.empty())
      held += (held.empty() ? "" : ", ") + std::string("`BadMachines.ShowRefusesEachWithItsPlace`");
    if (!item.cases.empty()) held += (held.empty() ? "" : ", ") + std::string("`BadInput.IsHeld`");
    for (const std::string& test : item.tests) held += (held.empty() ? "`" : ", `") + test + "`";
    if (!item.open.empty()) held += (held.empty() ? "" : "; ") + ("not held: " + item.open);
    std::string text;
    for (const std::string& one : said) text += (text.empty() ? "" : "<br>") + one;
    out += "| " + std::to_string(item.number) + " | " + cell(item.input) + " | " + text + " | " + held + " |\n";
  }
  return out;
}

TEST(BadInputsPage, IsMadeOfTheItems) {
  if (std::getenv("TOOTHPATH_WRITE_GOLDEN") != nullptr) write_file(kPage, page());
  EXPECT_EQ(file_text(kPage), page()) << "TOOTHPATH_WRITE_GOLDEN=1 writes it";
}

}  // namespace
}  // namespace toothpath::test
