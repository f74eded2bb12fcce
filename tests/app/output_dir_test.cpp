// The output directory and the hash: all files or none.
#include "app/base/output_dir.h"

#include <sys/stat.h>

#include <map>

#include "geometry/base/hash.h"
#include "geometry/mesh/file.h"
#include "machines/toml/regular_file.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

TEST(OutputDir, FilesAppearAtCommitOnly) {
  const TestDir dir;
  auto output = app::OutputDir::open(dir / "out", {"a.txt"});
  ASSERT_TRUE(output.has_value());
  ASSERT_TRUE(output->write("a.txt", "one").has_value());
  EXPECT_FALSE(std::filesystem::exists(dir / "out/a.txt"));
  EXPECT_EQ(*output->read_back("a.txt"), "one");
  ASSERT_TRUE(output->write("a.txt", "two").has_value());
  ASSERT_TRUE(output->commit().has_value());
  EXPECT_EQ(names_in(dir / "out"), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(file_text(dir / "out/a.txt"), "two");
}

TEST(OutputDir, WithoutCommitNothingIsLeftNotEvenTheDirectories) {
  const TestDir dir;
  {
    auto output = app::OutputDir::open(dir / "x/y/z", {"a.txt"});
    ASSERT_TRUE(output.has_value());
    ASSERT_TRUE(output->write("a.txt", "one").has_value());
  }
  EXPECT_FALSE(std::filesystem::exists(dir / "x"));
}

TEST(OutputDir, WhenOneFileCannotGetItsNameNoneDoes) {
  const TestDir dir;
  auto output = app::OutputDir::open(dir / "out", {"a.txt", "b.txt"});
  ASSERT_TRUE(output.has_value());
  ASSERT_TRUE(output->write("a.txt", "one").has_value());
  ASSERT_TRUE(output->write("b.txt", "two").has_value());
  std::filesystem::create_directories(dir / "out/b.txt/occupied");
  const auto committed = output->commit();
  ASSERT_FALSE(committed.has_value());
  EXPECT_EQ(committed.error().kind, DiagnosticKind::file_access);
  EXPECT_EQ(names_in(dir / "out"), std::vector<std::string>{"b.txt"});
}

TEST(OutputDir, ASymbolicLinkIsReplacedNotFollowed) {
  const TestDir dir;
  std::filesystem::create_directories(dir / "out");
  write_file(dir / "elsewhere", "mine");
  std::filesystem::create_symlink(dir / "elsewhere", dir / "out/a.txt");
  auto output = app::OutputDir::open(dir / "out", {"a.txt"});
  ASSERT_TRUE(output.has_value());
  ASSERT_TRUE(output->write("a.txt", "ours").has_value());
  ASSERT_TRUE(output->commit().has_value());
  EXPECT_EQ(file_text(dir / "elsewhere"), "mine");
  EXPECT_FALSE(std::filesystem::is_symlink(dir / "out/a.txt"));
}

TEST(OutputDir, LeftoversOfAKilledRunAreRemoved) {
  const TestDir dir;
  std::filesystem::create_directories(dir / "out");
  write_file(dir / "out/.toothpath-999999999-program.ngc", "half");
  { const auto output = app::OutputDir::open(dir / "out", {}); }
  EXPECT_TRUE(names_in(dir / "out").empty());
}

/// Old results with a program, and somebody's notes; returns the directory.
std::string finished_run(const TestDir& dir) {
  const std::string out = dir / "out";
  std::filesystem::create_directories(out);
  write_file(out + "/program.ngc", "G1");
  write_file(out + "/report.json",
             R"({"command":"run","job":"bad\u001bname","program":{"file":"program.ngc","sha256":"0123456789abcdef"}})");
  write_file(out + "/my notes.txt", "mine");
  return out;
}

const std::vector<std::string> kRun = {"program.", "report.json", "setup.html"};

TEST(OutputDir, OpeningChangesNothingAndSaysWhoseResultsStandThere) {
  const TestDir dir;
  const std::string out = finished_run(dir);
  { const auto output = app::OutputDir::open(out, kRun, {}, app::kPrevious); }
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"my notes.txt", "program.ngc", "report.json"}));
  const std::string note = app::OutputDir::closing_note();
  EXPECT_TRUE(note.starts_with(out + " stays as it was: run \"badname\" of 20")) << note;
  EXPECT_TRUE(note.ends_with(", program.ngc (sha256 0123456789ab)")) << note;
}

TEST(OutputDir, EarlierResultsMoveAsideOneGeneration) {
  const TestDir dir;
  const std::string out = finished_run(dir);
  {
    auto output = app::OutputDir::open(out, kRun, {}, app::kPrevious);
    ASSERT_TRUE(output && output->set_aside());
    EXPECT_EQ(names_in(out), (std::vector<std::string>{".toothpath-lock", "my notes.txt", "previous"}))
        << "before anything is written";
  }
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"my notes.txt", "previous"}))
      << "a run that writes nothing puts nothing back";
  EXPECT_EQ(names_in(out + "/previous"), (std::vector<std::string>{"program.ngc", "report.json"}));
  EXPECT_TRUE(app::OutputDir::closing_note().starts_with("what stood in " + out + " is in " + out + "/previous: run"))
      << app::OutputDir::closing_note();
  {  // nothing stands there: the folder keeps what it has
    auto output = app::OutputDir::open(out, kRun, {}, app::kPrevious);
    ASSERT_TRUE(output && output->set_aside() && output->write("report.json", "unverified") && output->commit());
  }
  {  // results without a program are none worth keeping in the place of a program
    auto output = app::OutputDir::open(out, kRun, {}, app::kPrevious);
    ASSERT_TRUE(output && output->set_aside());
    EXPECT_EQ(file_text(out + "/report.json"), "unverified");
    ASSERT_TRUE(output->write("program.nc", "G2") && output->write("setup.html", "sheet") && output->commit());
  }
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"my notes.txt", "previous", "program.nc", "setup.html"}))
      << "the old report gave way";
  EXPECT_EQ(file_text(out + "/previous/program.ngc"), "G1");
  {
    auto output = app::OutputDir::open(out, kRun, {}, app::kPrevious);
    ASSERT_TRUE(output && output->set_aside());
  }
  EXPECT_EQ(names_in(out + "/previous"), (std::vector<std::string>{"program.nc", "setup.html"}))
      << "no mix of two generations";
}

TEST(OutputDir, PreviousMustBeAFolderThatCanBeWritten) {
  for (const bool link : {false, true}) {
    const TestDir dir;
    const std::string out = finished_run(dir);
    std::filesystem::create_directories(dir / "elsewhere");
    if (link) std::filesystem::create_directory_symlink(dir / "elsewhere", out + "/previous");
    else write_file(out + "/previous", "mine");
    const auto output = app::OutputDir::open(out, kRun, {}, app::kPrevious);
    ASSERT_FALSE(output);
    EXPECT_EQ(output.error().kind, DiagnosticKind::file_access);
    EXPECT_EQ(output.error().position.file, out + "/previous");
    EXPECT_EQ(names_in(out).size(), 4u);
    EXPECT_EQ(file_text(out + "/program.ngc"), "G1");
  }
  if (::geteuid() == 0) return;  // root may write everywhere
  const TestDir dir;
  const std::string out = finished_run(dir);
  std::filesystem::create_directories(out + "/previous");
  std::filesystem::permissions(out + "/previous",
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_FALSE(app::OutputDir::open(out, kRun, {}, app::kPrevious));
  std::filesystem::permissions(out + "/previous", std::filesystem::perms::owner_all);
}

TEST(OutputDir, OneRunAtATime) {
  const TestDir dir;
  {
    const auto first = app::OutputDir::open(dir / "out", kRun);
    ASSERT_TRUE(first);
    const auto second = app::OutputDir::open(dir / "out", {"other.txt"});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, DiagnosticKind::file_access);
    EXPECT_NE(second.error().message.find("another run"), std::string::npos);
    EXPECT_EQ(names_in(dir / "out"), std::vector<std::string>{".toothpath-lock"});
  }
  write_file(dir / ".toothpath-lock", "");  // left by a run that was killed: nobody holds it
  EXPECT_TRUE(app::OutputDir::open(dir.path(), kRun));
  EXPECT_TRUE(names_in(dir.path()).empty());
}

TEST(OutputDir, AnInputThatWouldBeReplacedIsRefused) {
  const TestDir dir;
  const std::string out = finished_run(dir);
  std::filesystem::create_directories(out + "/previous");
  write_file(out + "/previous/report.json", "old");
  std::filesystem::create_symlink(out + "/report.json", dir / "link");
  for (const std::string& input :
       {out + "/report.json", out + "/../out/program.ngc", dir / "link", out + "/previous/report.json"}) {
    const auto refused = app::OutputDir::open(out, kRun, {"missing", input}, app::kPrevious);
    ASSERT_FALSE(refused) << input;
    EXPECT_EQ(refused.error().kind, DiagnosticKind::usage);
    EXPECT_EQ(refused.error().position.file, input);
  }
  EXPECT_TRUE(app::OutputDir::open(out, {"report.html"}, {out + "/program.ngc"})) << "not its own";
  EXPECT_TRUE(app::OutputDir::open(out, kRun, {out + "/my notes.txt"}));
}

// Files that only the job names are known when they have been read.
TEST(OutputDir, AnInputReadMeanwhileIsNotReplaced) {
  const TestDir dir;
  const std::string out = finished_run(dir);
  const auto before = names_in(out);
  auto output = app::OutputDir::open(out, kRun, {}, app::kPrevious);
  ASSERT_TRUE(output && output->keeps_inputs());
  ASSERT_TRUE(toml::read_input_file(out + "/report.json", 1000));
  for (const Status& refused : {output->keeps_inputs(), output->set_aside()}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, DiagnosticKind::usage);
    EXPECT_EQ(refused.error().position.file, out + "/report.json");
  }
  ASSERT_TRUE(output->write("report.json", "new"));
  EXPECT_FALSE(output->commit());
  EXPECT_EQ(names_in(out), before);
  EXPECT_NE(file_text(out + "/report.json"), "new");
}

// Whatever reads it: a mesh that a machine file names is an input like a job.
TEST(OutputDir, AMeshReadMeanwhileIsNotReplaced) {
  const TestDir dir;
  std::filesystem::create_directories(dir / "out");
  write_file(dir / "out/gear.stl", "mine");
  auto output = app::OutputDir::open(dir / "out", {"gear.stl"});
  ASSERT_TRUE(output && output->keeps_inputs());
  EXPECT_FALSE(mesh::load_mesh(dir / "out/../out/gear.stl"));  // were it no mesh
  const Status refused = output->keeps_inputs();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, DiagnosticKind::usage);
  ASSERT_TRUE(output->write("gear.stl", "new"));
  EXPECT_FALSE(output->commit());
  EXPECT_EQ(file_text(dir / "out/gear.stl"), "mine");
}

TEST(OutputDir, ProgramsGetTheirNamesLast) {
  const TestDir dir;
  auto output = app::OutputDir::open(dir / "out", kRun);
  ASSERT_TRUE(output && output->write("program.ngc", "G1") && output->write("report.json", "{}"));
  std::filesystem::create_directories(dir / "out/report.json/occupied");
  ASSERT_FALSE(output->commit());
  EXPECT_EQ(names_in(dir / "out"), std::vector<std::string>{"report.json"});
}

/// Every file, link and folder below a directory with its bytes or where it leads.
std::map<std::string, std::string> tree(const std::string& directory) {
  namespace fs = std::filesystem;
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(directory))
    all[fs::relative(entry.path(), directory)] = entry.is_symlink()        ? "-> " + fs::read_symlink(entry).string()
                                                 : entry.is_directory()    ? "folder"
                                                 : entry.is_regular_file() ? file_text(entry.path())
                                                                           : "other";
  return all;
}

/// A run in DIR from its beginning to its end, as far as it comes.
Status whole_run(const std::string& directory) {
  auto output = app::OutputDir::open(directory, kRun, {}, app::kPrevious);
  if (!output) return output.error();
  if (auto s = output->set_aside(); !s) return s;
  if (auto s = output->write("program.ngc", "new"); !s) return s;
  return output->commit();
}

// DIR may have come out of somebody's archive: whatever stands there, nothing outside is written, moved or removed, and
// of what is inside no file of somebody else.
TEST(OutputDir, NothingOutsideIsTouchedWhateverStandsThere) {
  namespace fs = std::filesystem;
  const std::string marks[] = {".toothpath-journal",
                               ".toothpath-done",
                               ".toothpath-aside",
                               ".toothpath-older-previous",
                               ".toothpath-kept-previous",
                               ".toothpath-lock",
                               "previous",
                               "program.ngc",
                               "report.json",
                               ".toothpath-999999999-program.ngc",
                               ".toothpath-999999999-gone",
                               fmt::format(".toothpath-{}-program.ngc", ::getpid()),
                               fmt::format(".toothpath-{}-journal", ::getpid())};
  const std::string kinds[] = {"file link", "folder link", "dangling link", "loop", "folder", "pipe", "hard link"};
  for (const std::string& mark : marks)
    for (const std::string& kind : kinds)
      for (const bool old_results : {false, true}) {
        SCOPED_TRACE(mark + " as " + kind + (old_results ? " above old results" : ""));
        const TestDir dir;
        const std::string out = dir / "out", outside = dir / "outside", at = out + "/" + mark;
        fs::create_directories(outside + "/victims/below");
        for (const char* name : {"/victim.txt", "/victims/program.ngc", "/victims/report.json", "/victims/thesis.txt",
                                 "/victims/below/report.json"})
          write_file(outside + name, "mine");
        fs::create_directories(out);
        write_file(out + "/my notes.txt", "mine");
        if (old_results) write_file(out + "/program.ngc", "G1");
        fs::remove(at);
        if (kind == "file link") fs::create_symlink(outside + "/victim.txt", at);
        else if (kind == "folder link") fs::create_directory_symlink("../outside/victims", at);
        else if (kind == "dangling link") fs::create_symlink(outside + "/not yet", at);
        else if (kind == "loop") fs::create_symlink(mark, at);
        else if (kind == "folder") fs::create_directories(at + "/my folder");
        else if (kind == "hard link") fs::create_hard_link(outside + "/victim.txt", at);
        else ASSERT_EQ(::mkfifo(at.c_str(), 0600), 0);
        const auto before = tree(outside);
        for (int k = 0; k < 2; ++k) {
          if (const Status ran = whole_run(out); !ran) {
            EXPECT_EQ(ran.error().kind, DiagnosticKind::file_access);
            EXPECT_TRUE(ran.error().position.file.starts_with(out)) << ran.error().text();
          }
          EXPECT_EQ(tree(outside), before);
          EXPECT_EQ(file_text(out + "/my notes.txt"), "mine");
        }
      }
}

TEST(OutputDir, AJournalNamesOutputsOfTheCommandOnly) {
  for (const char* name : {"../outside/victim.txt", "my notes.txt", "..", ".", "", "below/thesis.txt", "program.ngc/",
                           "./report.json", "../out/report.json"}) {
    const TestDir dir;
    const std::string out = finished_run(dir);
    std::filesystem::create_directories(dir / "outside");
    std::filesystem::create_directories(out + "/below");
    write_file(dir / "outside/victim.txt", "mine");
    write_file(out + "/below/thesis.txt", "mine");
    for (const std::string& journal : {std::string(name) + "\n", "report.json\n" + std::string(name) + "\n"}) {
      write_file(out + "/.toothpath-journal", journal);
      const auto before = tree(dir.path());
      const Status ran = whole_run(out);
      ASSERT_FALSE(ran) << name;
      EXPECT_EQ(ran.error().kind, DiagnosticKind::file_access);
      EXPECT_EQ(ran.error().position.file, out + "/.toothpath-journal");
      EXPECT_EQ(ran.error().position.line, std::count(journal.begin(), journal.end(), '\n'));
      EXPECT_EQ(tree(dir.path()), before);
    }
  }
}

TEST(OutputDir, WhatIsNotOursStaysInHiddenFolders) {
  for (const char* folder :
       {".toothpath-done", ".toothpath-older-previous", ".toothpath-kept-previous", ".toothpath-aside"}) {
    SCOPED_TRACE(folder);
    const TestDir dir;
    const std::string out = finished_run(dir), hidden = out + "/" + folder;
    std::filesystem::create_directories(hidden + "/my folder");
    std::filesystem::create_directories(out + "/previous");
    for (const std::string& place :
         {hidden + "/thesis.txt", hidden + "/my folder/thesis.txt", out + "/previous/thesis.txt"})
      write_file(place, "mine");
    for (int k = 0; k < 2; ++k) (void)whole_run(out).has_value();
    const auto all = tree(out);
    EXPECT_EQ(std::count_if(all.begin(), all.end(), [](const auto& one) { return one.second == "mine"; }), 4);
  }
}

TEST(OutputDir, AFolderBelowIsNoLink) {
  const TestDir dir;
  std::filesystem::create_directories(dir / "elsewhere");
  std::filesystem::create_directories(dir / "out");
  std::filesystem::create_directory_symlink(dir / "elsewhere", dir / "out/.own");
  const auto refused = app::OutputDir::open_below(dir / "out", ".own", kRun);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().position.file, dir / "out/.own");
  {
    auto output = app::OutputDir::open_below(dir / "other", ".own", kRun);
    ASSERT_TRUE(output && output->write("program.ngc", "G1"));
    EXPECT_EQ(output->final_path("program.ngc"), dir / "other/.own/program.ngc");
  }
  EXPECT_FALSE(std::filesystem::exists(dir / "other"));
}

// FIPS 180-4: one block, two blocks, and a million letters.
TEST(Sha256, ExamplesOfTheStandard) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace toothpath::test
