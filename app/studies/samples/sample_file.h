// The results of a study as files of one JSON line a sample, which processes of any number write side by side into one
// directory. The first line of a file is the head of the study: all that decides its results. A line is flushed as it
// is written; what a killed process leaves is taken up by what stands there.
#pragma once

#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/files/folder.h"
#include "app/studies/samples/shard.h"
#include "geometry/base/result.h"

namespace toothpath::samples {

/// Of a study: name, number of samples, and one line of JSON with {"study", "version", "key", "samples"} among its
/// keys.
struct Head {
  std::string study;
  int samples = 0;
  std::string line;  ///< without its line feed
  int version = 0;   ///< of what a sample of this study means
};
/// Reads a head. Errors: no JSON object, or one without these keys.
[[nodiscard]] Result<Head> read_head(const std::string& line);

/// The file of one shard, open for more lines.
class SampleFile {
 public:
  /// Opens DIRECTORY/samples.IofN.jsonl, or begins it; the directory is made where it does not exist. Lines that are
  /// whole are kept; a last one that is cut off goes, once all before it is known to be of this study.
  /// Errors: a head that is not this one, a line that is no sample of this shard (both with file and line); kind
  /// `file_access`: another process that writes this shard, a link in the place of the file, a file that has other
  /// names (hard links). A file that is refused keeps its bytes.
  [[nodiscard]] static Result<SampleFile> open(const std::string& directory, const Shard& shard, const Head& head);

  [[nodiscard]] bool has(int sample) const { return done_.contains(sample); }
  [[nodiscard]] std::size_t size() const { return done_.size(); }
  /// @param line  a JSON object with "sample", without its line feed
  [[nodiscard]] Status add(int sample, const std::string& line);
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  [[nodiscard]] Status take_up(const std::string& text, const Shard& shard, const Head& head);
  [[nodiscard]] Status write(const std::string& line);
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::set<int> done_;
};

struct PlacedLine {
  std::string text;
  SourcePosition place;
};
/// All samples of a study.
struct Merged {
  Head head;
  SourcePosition head_place;
  std::vector<PlacedLine> lines;  ///< by sample
  std::string text;               ///< head and lines: the same bytes however the study was cut
};
/// From all files samples.*.jsonl of the directory, however they were cut. Last lines that are cut off do not count.
/// Errors, with file and line: files of different studies; lines that are no samples; two different results of one
/// sample; samples that are missing, by number.
[[nodiscard]] Result<Merged> merge(const std::string& directory);

}  // namespace toothpath::samples
