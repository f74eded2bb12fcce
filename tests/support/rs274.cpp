#include "tests/support/rs274.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace toothpath::test {
namespace fs = std::filesystem;

Canonical interpret(const std::string& program, const std::string& name, const std::string& ini,
                    const std::string& parameters) {
  Canonical out;
  const char* given = std::getenv("TOOTHPATH_RS274");
  const std::string rs274 = given != nullptr ? given : std::string(TOOTHPATH_SOURCE_DIR) + "/.deps/rs274/rs274";
  if (!fs::exists(rs274)) {
    ADD_FAILURE() << rs274 << " is missing: run tools/get_rs274.sh";
    return out;
  }
  const fs::path dir = fs::path(testing::TempDir()) / ("toothpath_rs274_" + name + "_" + std::to_string(::getpid()));
  fs::create_directories(dir);
  std::ofstream(dir / "p.ngc") << program;
  std::ofstream(dir / "t.tbl") << "T1 P1 Z0 D4 ;\nT2 P2 Z0 D4 ;\n";
  std::ofstream(dir / "v.var") << parameters;
  if (!ini.empty()) std::ofstream(dir / "m.ini") << "[RS274NGC]\nPARAMETER_FILE = v.var\n" << ini;
  const std::string d = dir.string();
  const std::string command = "cd '" + d + "' && HOME='" + d + "' timeout 60 '" + rs274 + "'" +
                              (ini.empty() ? "" : " -i m.ini") + " -g -t t.tbl -v v.var p.ngc out.txt > log.txt 2>&1";
  const int status = std::system(command.c_str());
  out.exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::ifstream log(dir / "log.txt");
  out.messages.assign(std::istreambuf_iterator<char>(log), {});
  std::ifstream in(dir / "out.txt");
  for (std::string l; std::getline(in, l);) out.lines.push_back(l);
  fs::remove_all(dir);
  return out;
}

}  // namespace toothpath::test
