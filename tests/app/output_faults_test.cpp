// Dangers 24 and 29: every call that writes fails in turn, bytes change on the way to the disk, and the process is
// killed at random moments. Under a final name there is never anything but the whole file. The calls are wrapped by the
// linker (--wrap).
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <random>
#include <sstream>

#include "app/base/interruption.h"
#include "app/base/output_dir.h"

namespace {

std::atomic<std::size_t> asked_while_exchanging = 0;  ///< bytes

void* allocated(std::size_t size) {
  if (toothpath::app::SignalsBlocked::any()) asked_while_exchanging += size;
  if (void* place = std::malloc(size == 0 ? 1 : size)) return place;
  throw std::bad_alloc();
}

/// What is made to fail: the n-th of the watched calls, while armed.
struct Fault {
  bool armed = false;
  int at = 0, seen = 0;
  int error = ENOSPC;
  bool half = false;    ///< a write that fails has written half of its bytes before
  bool damage = false;  ///< instead: a rename gives the file another byte
  bool fired = false;
  bool kill = false;  ///< instead of failing: the process is killed before the call
};
Fault fault;

bool hit() {
  if (!fault.armed || fault.damage) return false;
  if (++fault.seen != fault.at) return false;
  if (fault.kill) ::kill(::getpid(), SIGKILL);
  fault.fired = true;
  errno = fault.error;
  return true;
}

}  // namespace

void* operator new(std::size_t size) { return allocated(size); }
void* operator new[](std::size_t size) { return allocated(size); }
void operator delete(void* place) noexcept { std::free(place); }
void operator delete[](void* place) noexcept { std::free(place); }
void operator delete(void* place, std::size_t) noexcept { std::free(place); }
void operator delete[](void* place, std::size_t) noexcept { std::free(place); }

extern "C" {
int __real_openat(int, const char*, int, ...);
ssize_t __real_write(int, const void*, size_t);
int __real_fsync(int);
int __real_close(int);
int __real_renameat(int, const char*, int, const char*);
int __real_mkdirat(int, const char*, mode_t);
int __real_unlinkat(int, const char*, int);
int __real_flock(int, int);

int __wrap_mkdirat(int folder, const char* name, mode_t mode) {
  return hit() ? -1 : __real_mkdirat(folder, name, mode);
}
int __wrap_unlinkat(int folder, const char* name, int flags) {
  return hit() ? -1 : __real_unlinkat(folder, name, flags);
}
int __wrap_flock(int descriptor, int operation) { return hit() ? -1 : __real_flock(descriptor, operation); }

int __wrap_openat(int folder, const char* name, int flags, ...) {
  va_list values;
  va_start(values, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(values, mode_t) : 0;
  va_end(values);
  return (flags & O_CREAT) != 0 && hit() ? -1 : __real_openat(folder, name, flags, mode);
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
int __wrap_renameat(int folder, const char* from, int other, const char* to) {
  if (hit()) return -1;
  const int result = __real_renameat(folder, from, other, to);
  if (fault.armed && fault.damage && ++fault.seen == fault.at && result == 0) {
    fault.fired = true;
    const int descriptor = __real_openat(other, to, O_WRONLY, 0);
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
  /// Name -> bytes of everything in it but folders; of what is below "previous" with that name before it.
  [[nodiscard]] std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(path_)) {
      if (entry.is_directory()) continue;
      std::ifstream in(entry.path(), std::ios::binary);
      all[fs::relative(entry.path(), path_).string()].assign(std::istreambuf_iterator<char>(in), {});
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

const std::vector<std::string> kOwn = {"program.", "report.json", "setup.html"};

/// A run: what an earlier one left moves aside (`aside`) or is replaced, the files are written, the program read back,
/// all named.
Status session(const std::string& path, int version, bool aside, std::size_t bytes = 30'000) {
  auto output = app::OutputDir::open(path, kOwn, {}, "previous");
  if (!output) return output.error();
  if (aside)
    if (const auto s = output->set_aside(); !s) return s;
  for (const auto& name : kNames)
    if (const auto s = output->write(name, content_of(name, version, bytes)); !s) return s;
  const auto read = output->read_back("program.ngc");
  if (!read) return read.error();
  if (*read != content_of("program.ngc", version, bytes)) return fail("read back something else");
  return output->commit();
}

/// The directory is opened and left again: what a run that was killed left is put in order.
Status opened(const std::string& path) {
  const auto output = app::OutputDir::open(path, kOwn, {}, "previous");
  return output ? Status(Ok{}) : Status(output.error());
}

Status faulty_session(const std::string& path, int version, bool aside, Fault f) {
  fault = f;
  fault.armed = true;
  Status result = session(path, version, aside, 300);
  fault.armed = false;
  return result;
}

/// Version of the whole set whose names begin with `folder`; 0: none of them is there; -1: a part of one, or parts of
/// two.
int version_in(const std::map<std::string, std::string>& files, const std::string& folder) {
  int version = -2;
  for (const auto& name : kNames) {
    const auto found = files.find(folder + name);
    int of_this = 0;
    for (int v = 1; v <= 3 && found != files.end(); ++v)
      if (found->second == content_of(name, v, 300)) of_this = v;
    if (found != files.end() && of_this == 0) return -1;
    if (version == -2) version = of_this;
    if (version != of_this) return -1;
  }
  return version;
}

constexpr const char* kMine = "my notes.txt";

/// Results of version 1 in "previous", of version 2 above them, and somebody's notes in both.
void two_generations(const std::string& path) {
  for (const auto& entry : fs::directory_iterator(path)) fs::remove_all(entry);
  fs::create_directories(path + "/previous");
  for (const auto& name : kNames) {
    std::ofstream(path + "/previous/" + name) << content_of(name, 1, 300);
    std::ofstream(path + "/" + name) << content_of(name, 2, 300);
  }
  for (const char* folder : {"/", "/previous/"}) std::ofstream(path + folder + kMine) << "mine";
}

/// What may stand there after a run of version 3 was stopped somewhere: every set whole, none lost but the oldest, and
/// that only for a newer one.
void expect_nothing_lost(const Place& place, bool aside, const std::string& when) {
  const auto files = place.files();
  const std::pair<int, int> now = {version_in(files, ""), version_in(files, "previous/")};
  const std::vector<std::pair<int, int>> allowed = aside ? std::vector<std::pair<int, int>>{{2, 1}, {0, 2}, {3, 2}}
                                                         : std::vector<std::pair<int, int>>{{2, 1}, {3, 1}};
  EXPECT_NE(std::find(allowed.begin(), allowed.end(), now), allowed.end())
      << when << ": version " << now.first << ", previous " << now.second;
  EXPECT_EQ(files.count(kMine), 1u) << when;
  // On its way from one "previous" to the next it may lie hidden until the directory is opened again; it is never lost.
  EXPECT_EQ(
      files.count(std::string("previous/") + kMine) + files.count(std::string(".toothpath-older-previous/") + kMine),
      1u)
      << when;
}

/// Hidden files and folders but temporary ones, which name the process that wrote them.
std::vector<std::string> marks_in(const std::string& path) {
  std::vector<std::string> marks;
  for (const auto& entry : fs::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(".toothpath-") && !std::isdigit(static_cast<unsigned char>(name[11]))) marks.push_back(name);
  }
  return marks;
}

// Disk full, I/O error, quota: the n-th call fails, for every n until the run does not come to it any more.
TEST(OutputFaults, EveryCallFailsInTurn) {
  for (const bool aside : {false, true})
    for (const auto& [error, half] : {std::pair(ENOSPC, true), std::pair(EIO, false)}) {
      const Place place;
      int n = 1;
      for (;; ++n) {
        two_generations(place.path());
        const std::string when = fmt::format("call {} error {} aside {}", n, error, aside);
        const Status result = faulty_session(place.path(), 3, aside,
                                             {.armed = true,
                                              .at = n,
                                              .seen = 0,
                                              .error = error,
                                              .half = half,
                                              .damage = false,
                                              .fired = false,
                                              .kill = false});
        if (!fault.fired) {
          EXPECT_TRUE(result);
          break;
        }
        expect_nothing_lost(place, aside, when);
        // What failed was of no matter (flushing a directory, taking away a mark): then all is there, and new.
        EXPECT_EQ(version_in(place.files(), "") == 3, result.has_value()) << when;
        if (!result) {
          EXPECT_EQ(result.error().kind, DiagnosticKind::file_access);
          EXPECT_NE(result.error().message.find(std::strerror(error)), std::string::npos) << result.error().message;
        }
        EXPECT_TRUE(opened(place.path())) << when;
        expect_nothing_lost(place, aside, when + ", opened again");
        EXPECT_TRUE(marks_in(place.path()).empty()) << when << " " << marks_in(place.path()).front();
      }
      EXPECT_GT(n, aside ? 45 : 30) << "4 calls a file, and the moves";
      const auto left = place.files();
      EXPECT_EQ(version_in(left, ""), 3);
      EXPECT_EQ(version_in(left, "previous/"), aside ? 2 : 1);
      EXPECT_EQ(left.size(), 2 * kNames.size() + 2) << "nothing hidden is left";
    }
}

// Danger 29: what lies under the final name is compared with what was written, after the rename; what stood there comes
// back.
TEST(OutputFaults, BytesThatChangeAtTheRenameAreFound) {
  int found = 0;
  for (int n = 1; n <= 12; ++n) {
    const Place place;
    for (const auto& name : kNames) std::ofstream(place.path() + "/" + name) << content_of(name, 1, 300);
    const Status result = faulty_session(
        place.path(), 3, false,
        {.armed = true, .at = n, .seen = 0, .error = 0, .half = false, .damage = true, .fired = false, .kill = false});
    if (result) continue;  // a rename of an old file or of a mark
    ++found;
    EXPECT_EQ(result.error().kind, DiagnosticKind::file_access);
    EXPECT_EQ(result.error().message,
              "the file on the disk differs from what was written; all files of this run are removed");
    EXPECT_EQ(version_in(place.files(), ""), 1) << n;
    EXPECT_TRUE(marks_in(place.path()).empty());
  }
  EXPECT_EQ(found, 3);
}

/// A child is killed before its n-th call; was it?
template <typename Work>
bool killed_at(int n, Work work) {
  const pid_t child = ::fork();
  if (child == 0) {
    fault = {
        .armed = true, .at = n, .seen = 0, .error = 0, .half = false, .damage = false, .fired = false, .kill = true};
    work();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

/// While nobody has put it in order: where a program stands, all the rest of its set does, and what stands in
/// "previous" is one set.
void expect_no_part(const Place& place, const std::string& when) {
  const auto files = place.files();
  if (files.count("program.ngc")) { EXPECT_GT(version_in(files, ""), 0) << when; }
  EXPECT_GE(version_in(files, "previous/"), 0) << when;
}

// Killed at every call, and the run that puts it in order killed at every call of its own.
TEST(OutputFaults, KilledAtEveryCall) {
  for (const bool aside : {false, true}) {
    int n = 1, marked = 0;
    for (;; ++n) {
      const Place place;
      two_generations(place.path());
      if (!killed_at(n, [&] { (void)session(place.path(), 3, aside, 300); })) break;
      expect_no_part(place, fmt::format("killed at {}, aside {}", n, aside));
      marked += marks_in(place.path()).size() > 1 ? 1 : 0;  // one is the lock
      for (int m = 1;; ++m) {
        const bool again = killed_at(m, [&] { (void)opened(place.path()); });
        expect_no_part(place, fmt::format("killed at {}, then at {}, aside {}", n, m, aside));
        if (!again) break;
      }
      expect_nothing_lost(place, aside, fmt::format("killed at {}, aside {}", n, aside));
      EXPECT_TRUE(marks_in(place.path()).empty()) << n;
      EXPECT_EQ(place.files().size(), (version_in(place.files(), "") > 0 ? 2 : 1) * kNames.size() + 2)
          << n << ": temporary files are gone";
    }
    EXPECT_GT(n, aside ? 45 : 30);
    EXPECT_GT(marked, 10);
  }
}

// Killed outright at random moments: what has a final name is whole, and the next run clears the rest away.
TEST(OutputFaults, KilledAtRandomMoments) {
  const Place place;
  std::mt19937_64 rng(9);
  // How long a run takes here decides when to kill.
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(session(place.path(), 0, true));
  const auto micros = std::max<long>(
      1000, std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin).count());
  int whole = 0, killed = 0;
  for (int trial = 1; trial <= 20; ++trial) {
    const pid_t child = ::fork();
    if (child == 0) {
      const Status s = session(place.path(), trial, true);
      ::_exit(s ? 0 : 1);
    }
    ::usleep(static_cast<useconds_t>(rng() % static_cast<std::uint64_t>(micros + micros / 4)));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    killed += WIFSIGNALED(status) ? 1 : 0;
    for (const auto& [path, bytes] : place.files()) {
      if (path.starts_with(".toothpath-")) continue;
      ++whole;
      const std::string name = fs::path(path).filename().string();
      ASSERT_TRUE(bytes == content_of(name, trial) || bytes == content_of(name, trial - 1) ||
                  bytes == content_of(name, std::max(0, trial - 2)))
          << trial << " " << path << " of " << bytes.size() << " bytes";
    }
    // The version before stands for the next trial, and nothing else.
    ASSERT_TRUE(session(place.path(), trial, true));
    ASSERT_EQ(place.files().size(), 2 * kNames.size());
  }
  EXPECT_GT(killed, 3);
  EXPECT_GT(whole, 0);
}

// The memory of an exchange is asked for before it begins: large files must not need more.
TEST(OutputFaults, AnExchangeNeedsLittleMemoryForLargeFiles) {
  const Place place;
  ASSERT_TRUE(session(place.path(), 1, true));
  asked_while_exchanging = 0;
  ASSERT_TRUE(session(place.path(), 2, true, 20'000'000));
  EXPECT_GT(asked_while_exchanging, 1000u);
  EXPECT_LT(asked_while_exchanging, 200'000u) << "bytes, all calls together";
}

// What may stand in the place of an output: a file that may not be written, a link into nowhere, a link to somebody's
// file.
TEST(OutputFaults, WhatStandsInThePlaceOfAnOutput) {
  const Place place;
  const std::string program = place.path() + "/program.ngc", report = place.path() + "/report.json";
  std::ofstream(program) << "old";
  fs::permissions(program, fs::perms::owner_read);
  fs::create_symlink("/nowhere/at/all", report);
  ASSERT_TRUE(session(place.path(), 5, false));
  EXPECT_FALSE(fs::is_symlink(report));
  for (const auto& name : kNames) EXPECT_EQ(place.files().at(name), content_of(name, 5));
}

}  // namespace
}  // namespace toothpath
