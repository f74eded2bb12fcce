// Dangers 24 and 29: every call that writes fails in turn, bytes change on the way to the disk, and the process is killed at random
// moments. Under a final name there is never anything but the whole file. The calls are wrapped by the linker (--wrap).
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "app/output_dir.h"

namespace {

/// What is made to fail: the n-th of the watched calls, while armed.
struct Fault {
  bool armed = false;
  int at = 0, seen = 0;
  int error = ENOSPC;
  bool half = false;     ///< a write that fails has written half of its bytes before
  bool damage = false;   ///< instead: a rename gives the file another byte
  bool fired = false;
};
Fault fault;

bool hit() {
  if (!fault.armed || fault.damage) return false;
  if (++fault.seen != fault.at) return false;
  fault.fired = true;
  errno = fault.error;
  return true;
}

}  // namespace

extern "C" {
int __real_open(const char*, int, ...);
ssize_t __real_write(int, const void*, size_t);
int __real_fsync(int);
int __real_close(int);
int __real_rename(const char*, const char*);

int __wrap_open(const char* path, int flags, ...) {
  va_list values;
  va_start(values, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(values, mode_t) : 0;
  va_end(values);
  return (flags & O_CREAT) != 0 && hit() ? -1 : __real_open(path, flags, mode);
}
ssize_t __wrap_write(int descriptor, const void* bytes, size_t size) {
  if (!hit()) return __real_write(descriptor, bytes, size);
  if (fault.half) (void)!__real_write(descriptor, bytes, size / 2);
  errno = fault.error;
  return -1;
}
int __wrap_fsync(int descriptor) { return hit() ? -1 : __real_fsync(descriptor); }
int __wrap_close(int descriptor) {
  const bool failed = hit();
  const int result = __real_close(descriptor);  // as on Linux: the descriptor is gone either way
  if (!failed) return result;
  errno = fault.error;
  return -1;
}
int __wrap_rename(const char* from, const char* to) {
  if (hit()) return -1;
  const int result = __real_rename(from, to);
  if (fault.armed && fault.damage && ++fault.seen == fault.at && result == 0) {
    fault.fired = true;
    const int descriptor = __real_open(to, O_WRONLY, 0);
    (void)!::pwrite(descriptor, "!", 1, 7);
    __real_close(descriptor);
  }
  return result;
}
}

namespace toothpath {
namespace {

namespace fs = std::filesystem;

class Place {
 public:
  Place() {
    std::string pattern = (fs::temp_directory_path() / "toothpath_faults_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~Place() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] std::string path() const { return path_.string(); }
  /// Name -> bytes of everything in it.
  [[nodiscard]] std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::directory_iterator(path_)) {
      std::ifstream in(entry.path(), std::ios::binary);
      all[entry.path().filename().string()].assign(std::istreambuf_iterator<char>(in), {});
    }
    return all;
  }

 private:
  fs::path path_;
};

const std::vector<std::string> kNames = {"program.ngc", "report.json", "setup.html"};

std::string content_of(const std::string& name, int version, std::size_t bytes = 30'000) {
  std::string text = name + " version " + std::to_string(version) + "\n";
  while (text.size() < bytes) text += "X1.2345 Y" + std::to_string(text.size()) + "\n";
  return text + "the end of " + name + "\n";
}

/// A run: what an earlier one left is removed, the files are written, the program read back, all named.
Status session(const std::string& path, int version) {
  auto output = OutputDir::open(path, {"program.", "report.json", "setup.html"});
  if (!output) return output.error();
  for (const auto& name : kNames)
    if (const auto s = output->write(name, content_of(name, version)); !s) return s;
  const auto read = output->read_back("program.ngc");
  if (!read) return read.error();
  if (*read != content_of("program.ngc", version)) return fail("read back something else");
  return output->commit();
}

Status faulty_session(const std::string& path, int version, Fault f) {
  fault = f;
  fault.armed = true;
  Status result = session(path, version);
  fault.armed = false;
  return result;
}

// Disk full, I/O error, quota: the n-th call fails, for every n until the run does not come to it any more.
TEST(OutputFaults, EveryCallFailsInTurn) {
  for (const auto& [error, half] : {std::pair(ENOSPC, true), std::pair(EIO, false)}) {
    const Place place;
    int n = 1;
    for (;; ++n) {
      for (const auto& name : kNames) std::ofstream(place.path() + "/" + name) << content_of(name, 1);  // of an earlier run
      const Status result = faulty_session(place.path(), 2, {.armed = true, .at = n, .seen = 0, .error = error, .half = half, .damage = false, .fired = false});
      const auto left = place.files();
      if (!fault.fired) {
        EXPECT_TRUE(result);
        break;
      }
      if (result) {  // what failed was of no matter (the directory's own flush): then all is there, and whole
        for (const auto& name : kNames) { EXPECT_EQ(left.count(name) ? left.at(name) : "none", content_of(name, 2)) << n; }
      } else {
        EXPECT_TRUE(left.empty()) << n << ": " << left.begin()->first;
        EXPECT_EQ(result.error().kind, DiagnosticKind::file_access);
        EXPECT_NE(result.error().message.find(std::strerror(error)), std::string::npos) << result.error().message;
      }
    }
    EXPECT_GT(n, 14) << "4 calls a file and 3 renames";
    const auto left = place.files();
    ASSERT_EQ(left.size(), kNames.size());
    for (const auto& name : kNames) EXPECT_EQ(left.at(name), content_of(name, 2));
  }
}

// Danger 29: what lies under the final name is compared with what was written, after the rename.
TEST(OutputFaults, BytesThatChangeAtTheRenameAreFound) {
  for (int n = 1; n <= 3; ++n) {
    const Place place;
    const Status result = faulty_session(place.path(), 3, {.armed = true, .at = n, .seen = 0, .error = 0, .half = false, .damage = true, .fired = false});
    ASSERT_TRUE(fault.fired);
    ASSERT_FALSE(result) << n;
    EXPECT_EQ(result.error().kind, DiagnosticKind::file_access);
    EXPECT_EQ(result.error().position.file, place.path() + "/" + kNames[static_cast<std::size_t>(n - 1)]);
    EXPECT_EQ(result.error().message, "the file on the disk differs from what was written; all files of this run are removed");
    EXPECT_TRUE(place.files().empty()) << n;
  }
}

// Killed outright at random moments: what has a final name is whole; the next run clears the rest away.
TEST(OutputFaults, KilledAtRandomMoments) {
  const Place place;
  std::mt19937_64 rng(9);
  // How long a run takes here decides when to kill.
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(session(place.path(), 0));
  const auto micros = std::max<long>(1000, std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin).count());
  int whole = 0, killed = 0;
  for (int trial = 1; trial <= 20; ++trial) {
    const pid_t child = ::fork();
    if (child == 0) {
      const Status s = session(place.path(), trial);
      ::_exit(s ? 0 : 1);
    }
    ::usleep(static_cast<useconds_t>(rng() % static_cast<std::uint64_t>(micros + micros / 4)));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    killed += WIFSIGNALED(status) ? 1 : 0;
    for (const auto& [name, bytes] : place.files()) {
      if (name.starts_with(".toothpath-")) continue;
      ++whole;
      ASSERT_TRUE(bytes == content_of(name, trial) || bytes == content_of(name, trial - 1)) << trial << " " << name << " of " << bytes.size() << " bytes";
    }
    // The version before stands for the next trial, and nothing else.
    ASSERT_TRUE(session(place.path(), trial));
    ASSERT_EQ(place.files().size(), kNames.size());
  }
  EXPECT_GT(killed, 3);
  EXPECT_GT(whole, 0);
}

// What may stand in the place of an output: a file that may not be written, a link into nowhere, a link to somebody's file.
TEST(OutputFaults, WhatStandsInThePlaceOfAnOutput) {
  const Place place;
  const std::string program = place.path() + "/program.ngc", report = place.path() + "/report.json";
  std::ofstream(program) << "old";
  fs::permissions(program, fs::perms::owner_read);
  fs::create_symlink("/nowhere/at/all", report);
  ASSERT_TRUE(session(place.path(), 5));
  EXPECT_FALSE(fs::is_symlink(report));
  for (const auto& name : kNames) EXPECT_EQ(place.files().at(name), content_of(name, 5));
}

}  // namespace
}  // namespace toothpath
