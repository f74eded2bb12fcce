// The reference of all keys against the readers: no key is read that it lacks, every key of it is taken, and the pages
// and schemas in docs are those that the program makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "app/job/words.h"
#include "app/reference/formats.h"
#include "app/reference/markdown.h"
#include "app/reference/schema.h"

namespace toothpath::test {
namespace {

namespace fs = std::filesystem;
using reference::Format;

const fs::path kRoot = TOOTHPATH_SOURCE_DIR;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kRoot / folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> keys_of(const Format& format) {
  std::vector<std::string> keys;
  for (const reference::Table& table : format.reference.tables)
    for (const reference::Key& key : table.keys) keys.push_back(reference::dotted(table.name, key.name));
  return keys;
}

/// Keys that the reader asks of these files and the reference lacks. Returns how many files could be read as TOML.
std::size_t expect_known(const Format& format, const std::vector<fs::path>& files) {
  std::size_t read = 0;
  for (const fs::path& path : files) {
    const auto tree = toml::parse_toml(bytes_of(path), path.string(), job::kJobSyntax);
    if (!tree) continue;
    ++read;
    toml::KeyNotes notes;
    (void)format.ask(*tree, notes);
    for (const toml::KeyNote& note : notes.keys) {
      if (note.presence == toml::Presence::misplaced) continue;
      const reference::Table* table = format.reference.find(note.table);
      EXPECT_TRUE(table && table->find(note.key)) << path << ": " << reference::dotted(note.table, note.key);
    }
  }
  return read;
}

TEST(Reference, EveryKeyThatAReaderAsksForIsThere) {
  const Format job = reference::job_format(), milling = reference::milling_machine_format(),
               shaper = reference::gear_shaper_format();
  std::size_t jobs = 0;
  for (const char* folder : {"samples", "tests/jobs", "tests/bad_jobs"}) jobs += expect_known(job, files_in(folder));
  EXPECT_GE(jobs, 190U);
  std::size_t machines = 0;
  for (const fs::path& path : files_in("machines/data"))
    machines += expect_known(bytes_of(path).find("\"gear_shaper\"") == std::string::npos ? milling : shaper, {path});
  EXPECT_GE(machines, 16U);
}

/// A document with every key that may stand beside the others: no key of it is unknown or of a wrong type.
void expect_taken(const Format& format, std::size_t least_documents) {
  EXPECT_GE(format.reference.documents.size(), least_documents);
  std::set<std::string> taken;
  for (const toml::TomlValue& document : format.reference.documents) {
    toml::KeyNotes notes;
    for (const Diagnostic& error : format.ask(document, notes)) {
      EXPECT_EQ(error.message.find("unknown key"), std::string::npos) << error.message;
      EXPECT_EQ(error.message.find(" must be a"), std::string::npos) << error.message;
    }
    for (const toml::KeyNote& note : notes.keys) taken.insert(reference::dotted(note.table, note.key));
  }
  for (const std::string& key : keys_of(format)) EXPECT_TRUE(taken.contains(key)) << key;
}

TEST(Reference, EveryKeyOfItIsTaken) {
  expect_taken(reference::job_format(), 3 * (4 * 5 + 2 * 2 * 5));
  expect_taken(reference::milling_machine_format(), 12);
  expect_taken(reference::gear_shaper_format(), 6);
}

/// A reader that asks for one key more has it in the reference at once.
TEST(Reference, HasWhatAReaderAsksFor) {
  const reference::Ask ask = [](const toml::TomlValue& document, toml::KeyNotes& notes) {
    toml::ReaderFindings findings(job::job_words());
    findings.notes = &notes;
    toml::TableReader root(document, "", findings);
    const auto type = root.variant("type", {"round", "square"});
    if (type == "round") (void)root.number("radius", {0, 10, " mm", true});
    if (type == "square") (void)root.number_or("side", {1, 20, " mm"}, 4.5);
    for (auto& hole : root.tables("hole", {0, 2})) {
      (void)hole.optional_word("form", {"through", "blind"});
      hole.finish();
    }
    root.finish();
    return std::move(findings.errors);
  };
  const reference::Reference found = reference::survey(ask, {toml::TomlValue{{}, toml::TomlTable{}}});
  ASSERT_EQ(found.tables.size(), 2U);
  const reference::Key *radius = found.tables[0].find("radius"), *side = found.tables[0].find("side"),
                       *hole = found.tables[0].find("hole"), *form = found.tables[1].find("form");
  ASSERT_TRUE(radius && side && hole && form);
  EXPECT_TRUE(radius->forms.front().required);
  ASSERT_EQ(radius->forms.front().when.size(), 1U);
  EXPECT_EQ(radius->forms.front().when.front().words, std::vector<std::string>{"round"});
  EXPECT_FALSE(side->forms.front().required);
  EXPECT_EQ(side->forms.front().absent, "4.5");
  EXPECT_EQ(side->forms.front().when.front().words, std::vector<std::string>{"square"});
  EXPECT_TRUE(hole->forms.front().when.empty());
  EXPECT_EQ(found.tables[1].name, "hole");
  EXPECT_EQ(reference::value_text(form->forms.front().shapes.front()), "`\"through\"`, `\"blind\"`");
  EXPECT_EQ(found.documents.size(), 2U);
}

/// Documents in which more deciding keys have other words than their first ones show no other key.
TEST(Reference, MoreWordsAtOnceShowNothingElse) {
  const Format usual = reference::job_format(), more = reference::job_format(reference::kMostOthers + 1);
  EXPECT_GT(more.reference.documents.size(), 2 * usual.reference.documents.size());
  EXPECT_EQ(reference::markdown_sections(usual), reference::markdown_sections(more));
}

/// What decides on a key must be one word of the file.
TEST(Reference, RefusesAReaderThatNoWordExplains) {
  const reference::Ask ask = [](const toml::TomlValue& document, toml::KeyNotes& notes) {
    toml::ReaderFindings findings(job::job_words());
    findings.notes = &notes;
    toml::TableReader root(document, "", findings);
    const auto a = root.variant("a", {"x", "y"}), b = root.variant("b", {"x", "y"});
    if (a == b) (void)root.optional_boolean("same");
    return std::move(findings.errors);
  };
  EXPECT_THROW((void)reference::survey(ask, {toml::TomlValue{{}, toml::TomlTable{}}}), std::logic_error);
}

TEST(Reference, EveryKeyHasItsSentenceAndEverySentenceItsKey) {
  const Format job = reference::job_format();
  const Format machines[] = {reference::milling_machine_format(), reference::gear_shaper_format()};
  const auto told = [](std::span<const Format> formats, std::span<const reference::Meaning> meanings) {
    std::set<std::string> keys;
    for (const Format& format : formats)
      for (const std::string& key : keys_of(format)) {
        keys.insert(key);
        EXPECT_NE(format.meaning(key), "") << key;
      }
    for (const reference::Meaning& meaning : meanings) {
      EXPECT_TRUE(std::any_of(keys.begin(), keys.end(), [&](const std::string& key) {
        return reference::stands_for(meaning.key, key);
      })) << meaning.key;
      EXPECT_TRUE(std::string_view(meaning.text).ends_with('.')) << meaning.text;
    }
  };
  told({&job, 1}, reference::job_meanings());
  told(machines, reference::machine_meanings());
}

/// TOOTHPATH_WRITE_GOLDEN=1 writes the files instead.
void expect_file(const char* name, const std::string& text) {
  const fs::path path = kRoot / "docs" / name;
  if (std::getenv("TOOTHPATH_WRITE_GOLDEN")) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
  }
  EXPECT_EQ(bytes_of(path), text) << name;
}

TEST(Reference, PagesAndSchemasInDocsAreThoseOfTheProgram) {
  expect_file("job_reference.md", reference::job_markdown());
  expect_file("machine_reference.md", reference::machine_markdown());
  expect_file("schema/job.schema.json", reference::job_schema());
  expect_file("schema/machine.schema.json", reference::machine_schema());
}

}  // namespace
}  // namespace toothpath::test
