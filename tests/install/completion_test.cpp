// What the shells propose and what the manual page says, against the help of every command; texts with signs that have
// a meaning in a shell or in roff.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>

#include "app/help/completion.h"
#include "app/help/man_page.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Words = std::set<std::string>;

/// What a shell command prints on both outputs.
std::string shell(const std::string& command) {
  const TestDir dir;
  const int status = std::system(fmt::format("{{ {}\n}} >{} 2>&1", command, dir / "out").c_str());
  const std::string printed = file_text(dir / "out");
  EXPECT_EQ(status, 0) << command << "\n" << printed;
  return printed;
}

Words lines_of(const std::string& text) {
  Words out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) out.insert(line.substr(0, line.find('\t')));
  return out;
}

/// Names at the beginning of the lines below a heading of the help: "  run  ..", "  -h,--help  ..".
Words listed_below(const std::string& help, const std::string& heading) {
  Words out;
  bool inside = false;
  std::istringstream in(help);
  const std::regex names("^  ([-a-z0-9]+)(?:,([-a-z0-9]+))?(?: .*)?$");
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (line.ends_with(':') && !line.starts_with(' ')) inside = line == heading;
    else if (inside && std::regex_match(line, match, names))
      for (std::size_t k : {1u, 2u})
        if (match[k].matched) out.insert(match[k]);
  }
  return out;
}

Words long_ones(Words options) {
  std::erase_if(options, [](const std::string& option) { return !option.starts_with("--"); });
  return options;
}

struct OfHelp {
  std::vector<std::string> words;  ///< of the command
  Words commands, options;
};

/// Of a command: the lines of its help below "Example:" or "Examples:".
std::vector<std::string> examples_in(const std::string& help) {
  std::vector<std::string> out;
  std::istringstream in(help);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("  toothpath ")) out.push_back(line.substr(2));
  return out;
}

/// Every command as its help shows it.
std::vector<OfHelp> commands_of_the_help(std::vector<std::string> words = {}) {
  auto asked = words;
  asked.emplace_back("--help");
  const std::string help = run_program(asked).out;
  std::vector<OfHelp> out = {{words, listed_below(help, "Subcommands:"), listed_below(help, "Options:")}};
  const Words inner = out.front().commands;
  for (const std::string& name : inner) {
    auto further = words;
    further.push_back(name);
    const auto below = commands_of_the_help(further);
    out.insert(out.end(), below.begin(), below.end());
  }
  return out;
}

/// A folder with a job, another file and a folder; the scripts of all shells.
class Completion : public ::testing::Test {
 protected:
  Completion() {
    std::filesystem::create_directory(dir_ / "folder");
    write_file(dir_ / "job.toml", "");
    write_file(dir_ / "text.nc", "");
    for (const char* name : {"bash", "zsh", "fish"}) {
      const auto printed = run_program({"completion", name});
      EXPECT_EQ(printed.exit_code, 0) << printed.err;
      write_file(scripts_ / name, printed.out);
    }
    std::filesystem::create_symlink(TOOTHPATH_BINARY, scripts_ / "toothpath");
  }

  /// @param line as typed, the last word to be completed
  Words in_bash(const std::string& line) {
    return lines_of(shell(fmt::format(
        "cd {} && PATH={}:$PATH bash --norc -c 'source {}; read -ra COMP_WORDS <<<\"{}\"; [[ \"{}\" != *\" \" ]] || "
        "COMP_WORDS+=(\"\"); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _toothpath; printf \"%s\\n\" "
        "\"${{COMPREPLY[@]}}\"'",
        dir_.path(), scripts_.path(), scripts_ / "bash", line, line)));
  }
  Words in_fish(const std::string& line) {
    return lines_of(
        shell(fmt::format("cd {} && HOME={} PATH={}:$PATH fish --no-config -c 'source {}; complete -C \"{}\"'",
                          dir_.path(), scripts_.path(), scripts_.path(), scripts_ / "fish", line)));
  }
  Words in_zsh(const std::string& line) {
    return lines_of(shell(
        fmt::format("cd {} && HOME={} PATH={}:$PATH TERM=xterm zsh -f {} {} '{}'", dir_.path(), scripts_.path(),
                    scripts_.path(), TOOTHPATH_SOURCE_DIR "/tests/install/zsh_proposals.zsh", scripts_ / "zsh", line)));
  }

  TestDir dir_, scripts_;
};

TEST_F(Completion, ProposesTheCommandsAndOptionsOfTheHelp) {
  const auto all = commands_of_the_help();
  ASSERT_GT(all.size(), 15u);
  const Words of_all = all.front().options;
  ASSERT_TRUE(of_all.contains("--json"));
  for (const OfHelp& command : all) {
    std::string line = "toothpath ";
    for (const std::string& word : command.words) line += word + " ";
    Words options = of_all;
    options.insert(command.options.begin(), command.options.end());
    if (!command.commands.empty()) {
      EXPECT_EQ(in_bash(line), command.commands) << line;
      EXPECT_EQ(in_fish(line), command.commands) << line;
    }
    EXPECT_EQ(in_bash(line + "-"), options) << line;
    EXPECT_EQ(in_fish(line + "--"), long_ones(options)) << line;
  }
}

// Slower than the others (a shell in a terminal each), therefore fewer lines.
TEST_F(Completion, OfZshProposesTheSame) {
  const auto all = commands_of_the_help();
  EXPECT_EQ(in_zsh("toothpath "), all.front().commands);
  for (const OfHelp& command : all) {
    if (command.words != std::vector<std::string>{"run"} &&
        command.words != std::vector<std::string>{"machine", "test"})
      continue;
    Words options = all.front().options;
    options.insert(command.options.begin(), command.options.end());
    EXPECT_EQ(in_zsh(fmt::format("toothpath {} --", fmt::join(command.words, " "))), long_ones(options));
  }
  EXPECT_EQ(in_zsh("toothpath --color a"), (Words{"always", "auto"}));
  EXPECT_EQ(in_zsh("toothpath new --gear "),
            (Words{"face", "double_helical", "offset", "bevel_herringbone", "cylindrical", "cylindrical_double_helical",
                   "straight_bevel", "spiral_bevel", "flank_grid"}));
  EXPECT_EQ(in_zsh("toothpath new --cut "), (Words{"ball", "line", "shaped", "finger"}));
  EXPECT_EQ(in_zsh("toothpath new --machine xyz"), (Words{"xyzac_large", "xyzac_trt", "xyzbc_trt"}));
  EXPECT_EQ(in_zsh("toothpath machine show xyz"), (Words{"xyzac_large", "xyzac_trt", "xyzbc_trt"}));
}

TEST_F(Completion, ProposesWhatAValueMayBe) {
  const struct {
    std::string line;
    Words words;
  } cases[] = {
      {"toothpath run ", {"job.toml", "folder"}},
      {"toothpath --threads 2 run ", {"job.toml", "folder"}},
      {"toothpath check job.toml ", {"job.toml", "folder", "text.nc"}},
      {"toothpath run job.toml --out ", {"folder"}},
      {"toothpath run --out folder j", {"job.toml"}},
      {"toothpath check --stock ", {"job.toml", "folder", "text.nc"}},
      {"toothpath contact --mate ", {"job.toml", "folder"}},
      {"toothpath run --color al", {"always"}},
      {"toothpath completion ", {"bash", "zsh", "fish", "machines"}},
      {"toothpath man", {"man-page"}},
      {"toothpath new --gear ",
       {"face", "double_helical", "offset", "bevel_herringbone", "cylindrical", "cylindrical_double_helical",
        "straight_bevel", "spiral_bevel", "flank_grid"}},
      {"toothpath new --gear bev", {"bevel_herringbone"}},
      {"toothpath new --cut ", {"ball", "line", "shaped", "finger"}},
      {"toothpath new --machine xyz", {"xyzac_large", "xyzac_trt", "xyzbc_trt"}},
      {"toothpath machine show xyz", {"xyzac_large", "xyzac_trt", "xyzbc_trt"}},
  };
  for (const auto& c : cases) {
    EXPECT_EQ(in_bash(c.line), c.words) << c.line;
    Words in_fish_words;
    for (const std::string& word : in_fish(c.line))
      in_fish_words.insert(word.ends_with('/') ? word.substr(0, word.size() - 1) : word);
    EXPECT_EQ(in_fish_words, c.words) << c.line;
  }
}

TEST_F(Completion, TheSyntaxIsThatOfTheShell) {
  for (const char* name : {"bash", "zsh", "fish"}) EXPECT_EQ(shell(fmt::format("{} -n {}", name, scripts_ / name)), "");
}

/// Examples name their command, options that it has, and as many arguments as it takes; the manual page has them, too.
TEST(ManualPage, AndHelpShowExamplesThatAreRight) {
  const std::string page = run_program({"man-page"}).out;
  for (const OfHelp& command : commands_of_the_help()) {
    if (!command.commands.empty()) continue;
    auto asked = command.words;
    asked.emplace_back("--help");
    const std::string help = run_program(asked).out, words = fmt::format("toothpath {}", fmt::join(command.words, " "));
    const auto examples = examples_in(help);
    EXPECT_TRUE(!examples.empty() && examples.size() <= 2) << words;
    for (const std::string& example : examples) {
      EXPECT_TRUE((example + " ").starts_with(words + " ")) << example;
      EXPECT_NE(page.find("\n\\fB" + std::regex_replace(example, std::regex("-"), "\\-") + "\\fR\n"), std::string::npos)
          << example;
      std::vector<std::string> arguments;
      std::istringstream in(example.substr(10, example.find_first_of("|>") - 10));
      for (std::string word; in >> word;) arguments.push_back(word);
      for (const std::string& word : arguments)
        EXPECT_TRUE(!word.starts_with("-") || command.options.contains(word)) << example << " has " << word;
      if (help.find("REQUIRED") == std::string::npos) continue;  // it would do something
      const TestDir dir;
      Launch launch;
      launch.arguments = arguments;
      launch.in_child = [&dir] { (void)!::chdir(dir.path().c_str()); };
      const auto run = run_program(launch);
      EXPECT_NE(run.exit_code, 2) << example << ": " << run.err;
    }
  }
}

TEST(ManualPage, NamesEveryCommandAndOption) {
  const TestDir dir;
  const auto page = run_program({"man-page"});
  ASSERT_EQ(page.exit_code, 0);
  write_file(dir / "toothpath.1", page.out);
  EXPECT_EQ(shell("mandoc -Tlint -Wwarning " + (dir / "toothpath.1")), "");
  const std::string text = shell(fmt::format("mandoc -Tascii {} | sed 's/.\x08//g'", dir / "toothpath.1"));
  for (const OfHelp& command : commands_of_the_help()) {
    if (!command.commands.empty()) continue;
    EXPECT_NE(text.find(fmt::format("   toothpath {}", fmt::join(command.words, " "))), std::string::npos);
    for (const std::string& option : command.options)
      EXPECT_TRUE(option == "-h" || option == "--help" || text.find("       " + option) != std::string::npos) << option;
  }
}

/// Everything that a shell or roff could take for more than a text.
help::Program awkward() {
  const std::string text = ".it's [odd]: \"x\" \\ $HOME `date` \\n %s {} -- 'y";
  help::Command command{"cut", text, {{"JOB", {help::ValueKind::job, "FILE", {}}, text}}, {}, {}};
  command.options.push_back({{"-o", "--odd"}, help::Value{help::ValueKind::text, text, {}}, true, true, text});
  return {{"toothpath", text, {}, {{{"--flag"}, {}, false, false, text}}, {command}}, "toothpath 0", text};
}

TEST(ManualPage, AndScriptsTakeTextsAsTexts) {
  const TestDir dir;
  const auto program = awkward();
  const std::string text = program.command.description;
  write_file(dir / "fish", help::fish_completion(program));
  write_file(dir / "bash", help::bash_completion(program));
  write_file(dir / "zsh", help::zsh_completion(program));
  write_file(dir / "page.1", help::man_page(program, "2026-01-31"));
  for (const char* name : {"bash", "zsh", "fish"}) EXPECT_EQ(shell(fmt::format("{} -n {}", name, dir / name)), "");
  EXPECT_EQ(shell(fmt::format("HOME={} fish --no-config -c 'source {}; complete -C \"toothpath cu\"'", dir.path(),
                              dir / "fish")),
            "cut\t" + text + "\n");
  EXPECT_EQ(shell("mandoc -Tlint -Wwarning " + (dir / "page.1")), "");
  const std::string shown = shell(fmt::format("mandoc -Tascii -O width=400 {} | sed 's/.\x08//g'", dir / "page.1"));
  std::size_t count = 0;
  for (auto at = shown.find(text); at != std::string::npos; at = shown.find(text, at + 1)) ++count;
  EXPECT_EQ(count, 7u) << shown;  // program, flag, command, argument, option with its value twice, footer
}

}  // namespace
}  // namespace toothpath::test
