// Inputs are safe: every file that a command reads is opened once, before anything in the output directory changes, and
// no output takes the place of one. The kernel tells which files were opened and moved, in their order (inotify).
#include <fmt/format.h>
#include <sys/inotify.h>

#include <array>
#include <map>
#include <regex>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

/// Opened inputs, and names that came to the output directory or left it. Hidden files do not count.
class Watch {
 public:
  Watch(const std::string& inputs, const std::string& outputs) : queue_(::inotify_init1(IN_NONBLOCK)) {
    in_ = ::inotify_add_watch(queue_, inputs.c_str(), IN_OPEN | IN_CLOSE);  // two like events in a row become one
    out_ = ::inotify_add_watch(queue_, outputs.c_str(), IN_MOVE | IN_CREATE | IN_DELETE | IN_MODIFY);
    EXPECT_GE(std::min(in_, out_), 0);
  }
  ~Watch() { ::close(queue_); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  struct Seen {
    std::map<std::string, int> opened;   ///< how often, by name
    bool opened_after_a_change = false;  ///< an input, when the output directory had changed already
    bool changed = false;
  };
  [[nodiscard]] Seen seen() const {
    Seen all;
    alignas(inotify_event) char bytes[1 << 16];
    for (ssize_t got = 0; (got = ::read(queue_, bytes, sizeof bytes)) > 0;)
      for (const char* at = bytes; at < bytes + got;) {
        const auto* event = reinterpret_cast<const inotify_event*>(at);
        at += sizeof *event + event->len;
        const std::string name = event->len > 0 ? event->name : "";
        EXPECT_EQ(event->mask & IN_Q_OVERFLOW, 0u);
        if (event->wd == in_ && (event->mask & IN_OPEN) != 0 && (event->mask & IN_ISDIR) == 0) {
          ++all.opened[name];
          all.opened_after_a_change |= all.changed;
        }
        if (event->wd == out_ && !name.starts_with(".toothpath-")) all.changed = true;
      }
    return all;
  }

 private:
  int queue_, in_ = -1, out_ = -1;
};

/// ASCII STL of a solid with sides of 10 mm, `x` mm beside the gear axis.
std::string tetrahedron(double x) {
  const double corners[4][3] = {{x, 0, 0}, {x + 10, 0, 0}, {x, 10, 0}, {x, 0, 10}};
  std::string text = "solid clamp\n";
  for (const std::array<int, 3>& facet : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int k : facet) text += fmt::format("vertex {} {} {}\n", corners[k][0], corners[k][1], corners[k][2]);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid clamp\n";
}

/// Jobs with everything that they name, in a folder of their own.
class Inputs : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(dir_ / "in");
    std::filesystem::create_directory(dir_ / "out");
    for (const char* sample : {"spur_quick", "offset_shaped"})
      write_file(in(std::string(sample) + ".toml"), file_text(kSamples + "/" + sample + ".toml"));
    for (const char* machine : {"xyzac_large", "y514"})
      write_file(in(std::string(machine) + ".toml"), file_text(kMachines + "/" + machine + ".toml"));
  }
  [[nodiscard]] std::string in(const std::string& name) const { return dir_ / ("in/" + name); }
  [[nodiscard]] std::string out(const std::string& name = "") const { return dir_ / ("out/" + name); }
  /// A measurement of the quick gear, 1 um everywhere.
  void measure(const std::string& path) const {
    ASSERT_EQ(run_program({"surface", in("spur_quick.toml"), "--out", dir_ / "nominal", "--quiet"}).exit_code, 0);
    std::string text = std::regex_replace(file_text(dir_ / "nominal/inspection.csv"), std::regex("\n"), ",1.0\n");
    text.replace(0, text.find('\n'), "zone,flank,row,column,x,y,z,i,j,k,deviation_um");
    write_file(path, text);
  }
  TestDir dir_;
};

TEST_F(Inputs, AreOpenedOnceAndBeforeAnyOutputMoves) {
  measure(in("measured.csv"));
  const std::string job = in("spur_quick.toml"), shaped = in("offset_shaped.toml");
  ASSERT_EQ(run_program({"run", job, "--out", dir_ / "first", "--quiet"}).exit_code, 0);
  std::filesystem::copy_file(dir_ / "first/program.ngc", in("program.ngc"));
  write_file(in("clamp.stl"), tetrahedron(200));
  struct Case {
    std::vector<std::string> words, inputs;
  };
  const std::vector<Case> cases = {
      {{"run", job}, {"spur_quick.toml", "xyzac_large.toml"}},
      {{"correct", job, "--measured", in("measured.csv")}, {"measured.csv", "spur_quick.toml", "xyzac_large.toml"}},
      {{"check", job, in("program.ngc"), "--fixture", in("clamp.stl")},
       {"clamp.stl", "program.ngc", "spur_quick.toml", "xyzac_large.toml"}},
      {{"surface", job}, {"spur_quick.toml"}},
      {{"shaper", shaped}, {"offset_shaped.toml", "y514.toml"}},
      {{"machine", "show", in("y514.toml")}, {"y514.toml"}},
      {{"machine", "test", in("xyzac_large.toml")}, {"xyzac_large.toml"}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.words[0] + " " + c.words[1]);
    std::vector<std::string> words = c.words;
    words.insert(words.end(), {"--out", out(), "--quiet"});
    EXPECT_LE(run_program(words).exit_code, 1);  // earlier results for the watched run
    const Watch watch(dir_ / "in", out());
    EXPECT_LE(run_program(words).exit_code, 1);
    const auto seen = watch.seen();
    EXPECT_TRUE(seen.changed);
    EXPECT_FALSE(seen.opened_after_a_change);
    std::map<std::string, int> once;
    for (const auto& name : c.inputs) once[name] = 1;
    EXPECT_EQ(seen.opened, once);
  }
}

// A machine file is named by its job, not on the command line.
TEST_F(Inputs, AFileThatTheJobNamesIsNotReplaced) {
  struct Case {
    std::string command, sample, machine, place;
  };
  for (const Case& c : {Case{"run", "spur_quick", "xyzac_large", "limits.json"},
                        Case{"run", "spur_quick", "xyzac_large", "previous/cl.csv"},
                        Case{"check", "spur_quick", "xyzac_large", "tooth.vtp"},
                        Case{"shaper", "offset_shaped", "y514", "shaper.json"}}) {
    SCOPED_TRACE(c.command + " " + c.place);
    std::filesystem::remove_all(out());
    ASSERT_EQ(run_program({"run", in("spur_quick.toml"), "--out", out(), "--quiet"}).exit_code, 0);
    std::filesystem::create_directory(out("previous"));
    std::filesystem::copy_file(out("program.ngc"), in("program.ngc"),
                               std::filesystem::copy_options::overwrite_existing);
    write_file(out(c.place), file_text(kMachines + "/" + c.machine + ".toml"));
    const std::string text = file_text(in(c.sample + ".toml"));
    write_file(in("job.toml"), replaced(text, "\"" + c.machine + ".toml\"", "\"../out/" + c.place + "\""));
    std::vector<std::string> words = {c.command, in("job.toml"), "--out", out()};
    if (c.command == "check") words.insert(words.begin() + 2, in("program.ngc"));
    const auto before = names_in(out());
    const std::string machine = file_text(out(c.place));
    const Finished refused = run_program(words);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    const std::string name = std::filesystem::path(c.place).filename();
    EXPECT_NE(refused.err.find(c.place + ": error: this input lies where the command writes its own " + name),
              std::string::npos)
        << refused.err;
    EXPECT_TRUE(file_text(out(c.place)) == machine);
    EXPECT_EQ(names_in(out()), before);
  }
}

// A mesh is named by the machine file, which the job names.
TEST_F(Inputs, ABodyOfTheMachineIsNotReplaced) {
  write_file(out("gear.stl"), tetrahedron(2000));
  write_file(in("xyzac_large.toml"), file_text(kMachines + "/xyzac_large.toml") +
                                         "\n[[body]]\nname = \"cabinet\"\nof = \"bed\"\nshape = \"mesh\"\n"
                                         "file = \"../out/gear.stl\"\n");
  const Finished refused = run_program({"run", in("spur_quick.toml"), "--out", out()});
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_NE(refused.err.find("gear.stl: error: this input lies where the command writes its own gear.stl"),
            std::string::npos)
      << refused.err;
  EXPECT_EQ(file_text(out("gear.stl")), tetrahedron(2000));
  EXPECT_EQ(names_in(out()), std::vector<std::string>{"gear.stl"});
}

// An input that is a link in the place of an output: the file behind it would stay, the user's name for it would go.
TEST_F(Inputs, ALinkInThePlaceOfAnOutputIsAnInputToo) {
  measure(in("measured.csv"));
  std::filesystem::create_symlink(in("measured.csv"), out("inspection.csv"));
  const Finished refused =
      run_program({"correct", in("spur_quick.toml"), "--measured", out("inspection.csv"), "--out", out()});
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_TRUE(std::filesystem::is_symlink(out("inspection.csv")));
}

// What a killed run left half-written is cleared away: it is no input.
TEST_F(Inputs, LeftoversOfAKilledRunAreNoInputs) {
  const std::string leftover = out(".toothpath-999999999-inspection.csv");
  measure(leftover);
  const std::string text = file_text(leftover);
  const Finished refused = run_program({"correct", in("spur_quick.toml"), "--measured", leftover, "--out", out()});
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_NE(refused.err.find(leftover + ": error: names that begin with \".toothpath-\" are the program's own in"),
            std::string::npos)
      << refused.err;
  EXPECT_TRUE(file_text(leftover) == text);
}

}  // namespace
}  // namespace toothpath::test
