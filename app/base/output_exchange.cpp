#include "app/base/output_exchange.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <initializer_list>

#include "postproc/controls/registry.h"

namespace toothpath::app {
namespace {

using files::cannot;
using files::Folder;
using files::Kind;

// Marks on the disk, in the order in which a move makes them.
constexpr const char* kAside = ".toothpath-aside";  ///< folder: files on their way out of the directory
constexpr const char* kJournal =
    ".toothpath-journal";  ///< file: kAside is complete; what stands under the names in here is new
constexpr const char* kDone = ".toothpath-done";  ///< kAside, renamed: the new files stay, those in here go
// "-" and the name of `previous` follow:
constexpr const char* kKept = ".toothpath-kept-";    ///< kAside, renamed: complete, becomes `previous`
constexpr const char* kOlder = ".toothpath-older-";  ///< `previous`, renamed: gives way to kKept
constexpr std::size_t kMostJournalBytes = 1 << 16;
constexpr std::size_t kMostDigits = 3;  // of a numbered program

bool is_nc_program(const std::string& name) {
  const auto extensions = controls::program_extensions();
  return std::any_of(extensions.begin(), extensions.end(), [&](const std::string& e) { return name.ends_with(e); });
}

Diagnostic no_mark(const Folder& folder, const std::string& name, const std::string& why) {
  return {DiagnosticKind::file_access,
          {folder.at(name), 0, 0},
          fmt::format("{}: no run of this command left it there, and nothing was touched; look at it and take it away, "
                      "or give another directory",
                      why)};
}

}  // namespace

OutputNames::OutputNames(const std::vector<std::string>& names) {
  for (const auto& name : names)
    if (name.back() != '.') others_.push_back(name);
    else if (name.ends_with("#.")) numbered_.push_back(name.substr(0, name.size() - 2));
    else
      for (const auto& extension : controls::program_extensions()) programs_.push_back(name + extension.substr(1));
}

bool OutputNames::is_program(std::string_view name) const {
  if (std::find(programs_.begin(), programs_.end(), name) != programs_.end()) return true;
  const std::size_t point = name.find('.');
  if (numbered_.empty() || point == std::string_view::npos) return false;
  const auto extensions = controls::program_extensions();
  if (std::find(extensions.begin(), extensions.end(), name.substr(point)) == extensions.end()) return false;
  return std::any_of(numbered_.begin(), numbered_.end(), [&](const std::string& head) {
    if (!name.starts_with(head) || head.size() > point) return false;
    const std::string_view digits = name.substr(head.size(), point - head.size());
    return !digits.empty() && digits.size() <= kMostDigits &&
           std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  });
}

bool OutputNames::contains(std::string_view name) const {
  return is_program(name) || std::find(others_.begin(), others_.end(), name) != others_.end();
}

std::vector<std::string> OutputNames::standing_in(const Folder& folder) const {
  std::vector<std::string> standing;
  const auto add = [&](const std::vector<std::string>& names) {
    std::copy_if(names.begin(), names.end(), std::back_inserter(standing),
                 [&](const std::string& name) { return folder.has(name); });
  };
  add(programs_);
  if (!numbered_.empty()) {
    const std::size_t before = standing.size();
    for (std::string& name : folder.names())
      if (is_program(name) && std::find(programs_.begin(), programs_.end(), name) == programs_.end())
        standing.push_back(std::move(name));
    std::sort(standing.begin() + static_cast<std::ptrdiff_t>(before), standing.end());
  }
  add(others_);
  return standing;
}

OutputExchange::OutputExchange(Folder folder, OutputNames names, std::string previous)
    : folder_(std::move(folder)), names_(std::move(names)), previous_(std::move(previous)) {
  if (previous_.empty()) return;
  kept_ = kKept + previous_;
  older_ = kOlder + previous_;
}

Status OutputExchange::check() const {
  const auto no_folders = [&](const Folder& folder) -> Status {
    for (const auto& name : names_.standing_in(folder))
      if (folder.kind(name) == Kind::folder) return cannot("replace", folder.at(name), EISDIR);
    return Ok{};
  };
  if (auto s = no_folders(folder_); !s) return s;
  if (previous_.empty() || !folder_.has(previous_)) return Ok{};
  const auto previous = folder_.below(previous_);
  if (!previous) return previous.error();
  if (!previous->may_write()) return cannot("keep earlier results in", previous->path(), errno);
  return no_folders(*previous);
}

/// Marks are a regular file and real folders, and `previous` is one.
Status OutputExchange::check_marks() const {
  if (!previous_.empty())
    if (const Kind kind = folder_.kind(previous_); kind != Kind::nothing && kind != Kind::folder)
      return cannot("keep earlier results in", folder_.at(previous_), ENOTDIR);
  if (const Kind kind = folder_.kind(kJournal); kind != Kind::nothing && kind != Kind::file)
    return no_mark(folder_, kJournal, "is not a regular file");
  for (const std::string& name : {std::string(kAside), std::string(kDone), kept_, older_})
    if (const Kind kind = folder_.kind(name); kind != Kind::nothing && kind != Kind::folder)
      return no_mark(folder_, name, "is not a folder");
  return Ok{};
}

/// Files of the names to kAside, programs first.
Status OutputExchange::take_out(const std::vector<std::string>& names) const {
  if (auto s = folder_.make_folder(kAside); !s) return s;
  const auto aside = folder_.below(kAside);
  if (!aside) return aside.error();
  for (const auto& name : names) {
    if (folder_.kind(name) == Kind::folder) continue;  // since check(): what would replace it fails with its name
    if (auto s = folder_.move(name, *aside, name); !s) {
      (void)put_back();  // what cannot move now is moved by the next recover()
      return s;
    }
  }
  return Ok{};
}

/// Files from kAside to their places, programs last (of whatever command they are); nobody else's file is overwritten.
Status OutputExchange::put_back() const {
  if (!folder_.has(kAside)) return Ok{};
  const auto aside = folder_.below(kAside);
  if (!aside) return aside.error();
  auto names = aside->names();
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return !is_nc_program(name); });
  for (const auto& name : names) {
    if (folder_.has(name)) return cannot("put back what a run that was killed left", aside->at(name), EEXIST);
    if (auto s = aside->move(name, folder_, name); !s) return s;
  }
  return folder_.remove_folder(kAside);
}

Status OutputExchange::recover() const {
  if (auto s = check_marks(); !s) return s;
  if (folder_.has(kDone)) {
    if (auto s = end_replace(); !s) return s;
  } else if (folder_.has(kJournal)) {
    if (auto s = undo_replace(); !s) return s;
  }
  if (auto s = put_back(); !s) return s;
  return previous_.empty() ? Status(Ok{}) : recover_previous();
}

Status OutputExchange::set_aside() const {
  if (auto s = take_out(names_.standing_in(folder_)); !s) return s;
  folder_.flush();
  if (auto s = aside_to_previous(); !s) {
    (void)put_back();
    return s;
  }
  folder_.flush();
  (void)end_previous();  // what stays of the older set is hidden, and goes with the next recover()
  return Ok{};
}

/// Three renames of whole folders; failed: kAside is complete again and `previous` as it was.
Status OutputExchange::aside_to_previous() const {
  if (auto s = folder_.move(kAside, folder_, kept_); !s) return s;
  const bool replaces = folder_.has(previous_);
  if (auto s = replaces ? folder_.move(previous_, folder_, older_) : Status(Ok{}); !s) {
    (void)folder_.move(kept_, folder_, kAside);
    return s;
  }
  if (auto s = folder_.move(kept_, folder_, previous_); !s) {
    if (replaces) (void)folder_.move(older_, folder_, previous_);
    (void)folder_.move(kept_, folder_, kAside);
    return s;
  }
  return Ok{};
}

Status OutputExchange::recover_previous() const {
  if (folder_.has(kept_)) {  // complete: it becomes `previous`
    if (folder_.has(previous_) && !folder_.has(older_))
      if (auto s = folder_.move(previous_, folder_, older_); !s) return s;
    if (auto s = folder_.move(kept_, folder_, previous_); !s) return s;
  } else if (folder_.has(older_) && !folder_.has(previous_)) {
    return folder_.move(older_, folder_, previous_);
  }
  return end_previous();
}

/// Of the set before the last one our files go; what somebody else put there stays in `previous`.
Status OutputExchange::end_previous() const {
  if (!folder_.has(older_)) return Ok{};
  const auto older = folder_.below(older_), previous = folder_.below(previous_);
  if (!older) return older.error();
  if (!previous) return previous.error();
  for (const auto& name : older->names()) {
    const bool ours = names_.contains(name) && older->kind(name) != Kind::folder;
    if (!ours && previous->has(name)) return cannot("keep what lies in", older->at(name), EEXIST);
    if (auto s = ours ? older->remove(name) : older->move(name, *previous, name); !s) return s;
  }
  return folder_.remove_folder(older_);
}

Status OutputExchange::write_journal(const std::vector<NewFile>& files) const {
  const std::string temporary = fmt::format(".toothpath-{}-journal", ::getpid());
  std::string text;
  for (const auto& file : files) text += file.name + "\n";
  if (auto s = folder_.remove(temporary); !s) return s;
  if (auto s = folder_.write_new(temporary, text); !s) return s;
  auto named = folder_.move(temporary, folder_, kJournal);
  if (!named) (void)folder_.remove(temporary);
  return named;
}

/// Names in the order in which they were given.
Result<std::vector<std::string>> OutputExchange::read_journal() const {
  const auto journal = folder_.read(kJournal, kMostJournalBytes);
  if (!journal) return journal.error();
  std::vector<std::string> names;
  std::string_view left = *journal;
  while (!left.empty()) {
    const std::size_t end = left.find('\n');
    names.emplace_back(left.substr(0, end));
    left.remove_prefix(end == std::string_view::npos ? left.size() : end + 1);
    if (!names_.contains(names.back())) {
      Diagnostic foreign = no_mark(folder_, kJournal, fmt::format("\"{}\" is no output of this command", names.back()));
      foreign.position.line = static_cast<int>(names.size());
      foreign.position.column = 1;
      return foreign;
    }
  }
  return names;
}

/// New files go, then the journal, then what they replaced comes back: in this order none of the old ones is taken for
/// a new one.
Status OutputExchange::undo_replace() const {
  const auto names = read_journal();
  if (!names) return names.error();
  for (auto it = names->rbegin(); it != names->rend(); ++it)  // programs were named last
    if (folder_.kind(*it) != Kind::folder)
      if (auto s = folder_.remove(*it); !s) return s;
  if (auto s = folder_.remove(kJournal); !s) return s;
  return put_back();
}

/// The journal first: while it stands, kDone says that the new files stay.
Status OutputExchange::end_replace() const {
  const auto done = folder_.below(kDone);
  if (!done) return done.error();
  const auto names = done->names();
  for (const auto& name : names)
    if (!names_.contains(name) || done->kind(name) == Kind::folder)
      return no_mark(*done, name, "is no output of this command");
  if (auto s = folder_.remove(kJournal); !s) return s;
  for (const auto& name : names)
    if (auto s = done->remove(name); !s) return s;
  return folder_.remove_folder(kDone);
}

Status OutputExchange::replace(const std::vector<NewFile>& files, const std::function<Status()>& verify) const {
  if (auto s = take_out(names_.standing_in(folder_)); !s) return s;
  folder_.flush();
  if (auto s = write_journal(files); !s) {
    (void)put_back();
    return s;
  }
  const auto named = [&]() -> Status {
    for (const auto& file : files)
      if (auto s = folder_.move(file.temporary, folder_, file.name); !s) {
        s.error().position.file = folder_.at(file.name);
        return s;
      }
    folder_.flush();
    if (auto s = verify(); !s) return s;
    return folder_.move(kAside, folder_, kDone);
  }();
  if (!named) {
    (void)undo_replace();  // what cannot be undone now is undone by the next recover()
    return named;
  }
  (void)end_replace();  // or by the next recover()
  return Ok{};
}

}  // namespace toothpath::app
