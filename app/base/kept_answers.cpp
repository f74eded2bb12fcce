#include "app/base/kept_answers.h"

#include <unistd.h>

#include <filesystem>

#include "app/files/folder.h"
#include "geometry/base/printable.h"

namespace toothpath::app {
namespace {

constexpr std::string_view kHead = "# answers to `toothpath new`: the same command with --resume goes on with them\n";
constexpr std::size_t kMostBytes = 1 << 20;

}  // namespace

KeptAnswers::KeptAnswers(const std::string& job)
    : path_(job + ".answers"),
      folder_(std::filesystem::path(path_).parent_path().string()),
      name_(std::filesystem::path(path_).filename().string()) {
  if (folder_.empty()) folder_ = ".";
}

bool KeptAnswers::there() const {
  const auto folder = files::Folder::open(folder_);
  return folder && folder->has(name_);
}

Result<std::vector<SaidAnswer>> KeptAnswers::read() const {
  const auto folder = files::Folder::open(folder_);
  if (!folder) return folder.error();
  const auto text = folder->read(name_, kMostBytes);
  if (!text) return text.error();
  if (!text->starts_with(kHead))
    return fail_at({path_, 1, 1}, "these are no answers to `toothpath new`: their first line is another");
  std::vector<SaidAnswer> said;
  int line = 2;
  for (std::size_t at = kHead.size(), end; at < text->size(); at = end + 1, ++line) {
    end = text->find('\n', at);
    const std::string_view row = std::string_view(*text).substr(at, end == std::string::npos ? end : end - at);
    const auto tab = row.find('\t');
    if (end == std::string::npos || tab == std::string_view::npos || !row.starts_with("--"))
      return fail_at({path_, line, 1}, "\"{}\" is no answer: an option, a tab and what was said are needed",
                     printable(row));
    said.push_back({std::string(row.substr(0, tab)), std::string(row.substr(tab + 1))});
  }
  return said;
}

Status KeptAnswers::write(std::span<const SaidAnswer> said) const {
  const auto folder = files::Folder::open(folder_);
  if (!folder) return folder.error();
  if (said.empty()) return folder->remove(name_);
  std::string text(kHead);
  for (const SaidAnswer& one : said) text += one.option + "\t" + one.answer + "\n";
  const std::string part = fmt::format("{}.{}.part", name_, ::getpid());
  if (auto written = folder->write_new(part, text); !written) return written;
  return folder->move(part, *folder, name_);
}

}  // namespace toothpath::app
