// Every reader of the program as a function of bytes, with seeds: what a fuzzer needs. Bytes give a result or a located
// refusal; everything else (a signal, an exception, an endless loop, a message with control characters) is a fault.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace toothpath::test {

struct ByteReader {
  std::string name;     ///< "job", "nc_fanuc"
  std::string letters;  ///< that its texts are made of: damage often leaves words that can be read
  std::vector<std::string> seeds;
  /// Reads; what is wrong with the answer. Empty: nothing.
  std::function<std::string(std::string_view bytes)> fault_of;
  int cost = 1;  ///< of one reading: it gets so many times fewer
};

/// All of them, each made once.
[[nodiscard]] const std::vector<ByteReader>& fuzzed_readers();

}  // namespace toothpath::test
